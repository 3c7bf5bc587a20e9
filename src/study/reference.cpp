#include "study/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <span>

#include "base/content_hash.h"
#include "base/hash.h"
#include "image/atomic_file.h"
#include "pipeline/casting/cast_choice.h"
#include "pipeline/core/display_values.h"
#include "study/frame_series.h"

namespace pprt {

Tracer tracer_of(const Subject& subject) {
  Tracer tracer(subject.scene, subject.camera);
  tracer.set_time(subject.time);
  return tracer;
}

namespace {

Color displayed(const Color& c) {
  return {std::clamp(c.x, 0.0f, 1.0f), std::clamp(c.y, 0.0f, 1.0f), std::clamp(c.z, 0.0f, 1.0f)};
}

// Sets a row to the means of n x n samples of each pixel. `place` maps a pixel's and a cell's number to a
// place within the cell.
template <typename Place>
void trace_row(const Subject& subject, int y, int n, const Place& place, Image& image) {
  Tracer tracer = tracer_of(subject);
  for (int x = 0; x < image.width; ++x) {
    const auto pixel = static_cast<std::uint64_t>(y) * 0x10000u + static_cast<std::uint64_t>(x);
    Vec3d sum(0, 0, 0);
    for (int cell = 0; cell < n * n; ++cell) {
      const Vec2d at = place(pixel, cell);
      const RaySample sample =
          tracer.trace(x + (cell % n + at.x) / n, y + (cell / n + at.y) / n, {}, 1.0 / n);
      sum += Vec3d(displayed(sample.color));
    }
    image.at(x, y) = Color(sum / (n * n));
  }
}

// Random places. The two halves of a reference have other cells' numbers.
auto random_places(int first_cell) {
  return [first_cell](std::uint64_t pixel, int cell) {
    constexpr std::uint64_t kSeed = 0x2545f4914f6cdd1du;  // unlike those of the samplers
    const std::uint64_t index = 2 * static_cast<std::uint64_t>(first_cell + cell);
    return Vec2d(uniform(kSeed, pixel, index), uniform(kSeed, pixel, index + 1));
  };
}

// Colours at 16 x 16 points, as text.
std::string fingerprint(const Subject& subject) {
  constexpr int kPoints = 16;
  Tracer tracer = tracer_of(subject);
  std::string text;
  for (int i = 0; i < kPoints * kPoints; ++i) {
    const int row = i / kPoints, column = i % kPoints;
    const Color c = tracer
                        .trace((column + 0.5) / kPoints * subject.camera.width,
                               (row + 0.5) / kPoints * subject.camera.height)
                        .color;
    text += fmt::format("{} {} {}\n", c.x, c.y, c.z);
  }
  return text;
}

std::string camera_text(const Camera& c) {
  return fmt::format("{} {} {} {} {} {} {} {} {} {} {} {}", c.eye.x, c.eye.y, c.eye.z, c.forward.x,
                     c.forward.y, c.forward.z, c.up.x, c.up.y, c.up.z, c.slope_per_pixel, c.width, c.height);
}

// In a file: own_rmse, then the pixels' colours, as this machine holds them.
std::string to_bytes(const Reference& reference) {
  const std::size_t size = reference.image.pixels.size() * sizeof(Color);
  std::string bytes(sizeof(double) + size, '\0');
  std::memcpy(bytes.data(), &reference.own_rmse, sizeof(double));
  std::memcpy(bytes.data() + sizeof(double), std::as_bytes(std::span(reference.image.pixels)).data(), size);
  return bytes;
}

std::optional<Reference> from_file(const std::filesystem::path& path, const Camera& camera, int samples) {
  if (!std::filesystem::exists(path)) return std::nullopt;
  const std::string bytes = read_whole_file(path);
  Reference reference{Image(camera.width, camera.height), samples};
  const std::size_t size = reference.image.pixels.size() * sizeof(Color);
  if (bytes.size() != sizeof(double) + size) return std::nullopt;
  std::memcpy(&reference.own_rmse, bytes.data(), sizeof(double));
  std::memcpy(reinterpret_cast<char*>(reference.image.pixels.data()), bytes.data() + sizeof(double), size);
  return reference;
}

}  // namespace

Image supersampled(const Subject& subject, int n) {
  const auto centre = [](std::uint64_t, int) { return Vec2d(0.5, 0.5); };
  Image image(subject.camera.width, subject.camera.height);
  for (int y = 0; y < image.height; ++y) trace_row(subject, y, n, centre, image);
  return image;
}

Reference converged_reference(const Subject& subject, int n) {
  const Camera& camera = subject.camera;
  Image first(camera.width, camera.height), second = first;
  run_concurrently(static_cast<std::size_t>(camera.height), [&](std::size_t y) {
    trace_row(subject, static_cast<int>(y), n, random_places(0), first);
    trace_row(subject, static_cast<int>(y), n, random_places(n * n), second);
  });
  Reference reference{Image(camera.width, camera.height), 2 * n * n};
  reference.own_rmse = 0.5 * rmse_of(first, second);
  for (std::size_t i = 0; i < first.pixels.size(); ++i) {
    reference.image.pixels[i] = (first.pixels[i] + second.pixels[i]) * 0.5f;
  }
  return reference;
}

Reference cached_reference(const std::string& scene, const Subject& subject, int n,
                           const std::filesystem::path& directory) {
  if (directory.empty()) return converged_reference(subject, n);
  const std::string key = fmt::format("{}\n{}\n{}\n{}\n{}", scene, camera_text(subject.camera), subject.time,
                                      n, fingerprint(subject));
  const std::filesystem::path path = directory / ("reference-" + content_hash(key) + ".raw");
  if (std::optional<Reference> kept = from_file(path, subject.camera, 2 * n * n)) return std::move(*kept);
  Reference reference = converged_reference(subject, n);
  write_whole_file(path, to_bytes(reference));
  return reference;
}

std::filesystem::path default_cache_directory() {
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache) {
    return std::filesystem::path(cache) / "pprt";
  }
  if (const char* home = std::getenv("HOME"); home && *home) {
    return std::filesystem::path(home) / ".cache" / "pprt";
  }
  return {};
}

double rmse_of(const Image& image, const Image& reference) {
  double sum = 0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    sum += display_error(image.pixels[i], reference.pixels[i]);
  }
  return std::sqrt(sum / static_cast<double>(image.pixels.size()));
}

}  // namespace pprt
