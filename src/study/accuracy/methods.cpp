#include "study/accuracy/methods.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <random>
#include <set>
#include <utility>

#include "image/contact_sheet.h"
#include "parallel/balance/partition.h"
#include "parallel/exchange/samplers.h"
#include "pipeline/mesh/reconstruction.h"
#include "pipeline/mesh/sample_mesh.h"
#include "pipeline/mesh/seeds.h"
#include "study/word_list.h"
#include "trace/tracer_probe.h"

namespace pprt {
namespace {

constexpr int kTilePixels = 32;

struct Size {
  int width, height;
};

// Returns the size of the grid with `density` samples per pixel.
Size grid_size(const Camera& camera, double density) {
  const auto along = [&](int pixels) {
    return std::max(2, static_cast<int>(std::lround(pixels * std::sqrt(density))));
  };
  return {along(camera.width), along(camera.height)};
}

double samples_per_pixel(double samples, const Camera& camera) {
  return samples / (static_cast<double>(camera.width) * camera.height);
}

// Place of a pixel's centre between two samples of a row.
struct Between {
  int low;
  float share;  // of the one after `low`
};

std::vector<Between> between_samples(int pixels, int count) {
  std::vector<Between> places;
  places.reserve(static_cast<std::size_t>(pixels));
  for (int i = 0; i < pixels; ++i) {
    const double at = std::clamp((i + 0.5) * count / pixels - 0.5, 0.0, count - 1.0);
    const int low = std::min(static_cast<int>(at), count - 2);
    places.push_back({low, static_cast<float>(at - low)});
  }
  return places;
}

Image bilinear(const Image& grid, int width, int height) {
  const std::vector<Between> columns = between_samples(width, grid.width);
  const std::vector<Between> rows = between_samples(height, grid.height);
  Image image(width, height);
  std::vector<Color> row(static_cast<std::size_t>(grid.width));
  for (int y = 0; y < height; ++y) {
    const auto [top, down] = rows[static_cast<std::size_t>(y)];
    for (int i = 0; i < grid.width; ++i) {
      row[static_cast<std::size_t>(i)] = grid.at(i, top) + (grid.at(i, top + 1) - grid.at(i, top)) * down;
    }
    for (int x = 0; x < width; ++x) {
      const auto [left, right] = columns[static_cast<std::size_t>(x)];
      const auto at = static_cast<std::size_t>(left);
      image.at(x, y) = row[at] + (row[at + 1] - row[at]) * right;
    }
  }
  return image;
}

Image uniform_picture(Tracer& tracer, const Camera& camera, const Size& size) {
  Image grid(size.width, size.height);
  const double step_x = static_cast<double>(camera.width) / size.width;
  const double step_y = static_cast<double>(camera.height) / size.height;
  const double footprint = std::min({1.0, step_x, step_y});
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      grid.at(x, y) = tracer.trace((x + 0.5) * step_x, (y + 0.5) * step_y, {}, footprint).color;
    }
  }
  if (size.width == camera.width && size.height == camera.height) return grid;
  return size.width < camera.width ? bilinear(grid, camera.width, camera.height)
                                   : resize(grid, camera.width, camera.height);
}

// Makes a picture from a grid of samples at each density: `make` returns that of a grid's size.
template <typename Make>
void run_grids(const CurveTask& task, const Make& make) {
  for (const double density : task.densities) {
    Rendering rendering = make(grid_size(task.subject.camera, density));
    const double seconds = rendering.seconds;
    task.sink(std::move(rendering));
    if (seconds > task.limit_s) return;
  }
}

void run_uniform(const CurveTask& task) {
  const Camera& camera = task.subject.camera;
  Tracer tracer = tracer_of(task.subject);
  run_grids(task, [&](const Size& size) {
    const double begin = thread_cpu_seconds();
    Image image = uniform_picture(tracer, camera, size);
    const double seconds = thread_cpu_seconds() - begin,
                 samples = static_cast<double>(size.width) * size.height;
    return Rendering{samples_per_pixel(samples, camera), seconds, std::move(image)};
  });
}

// The weights are learned from errors of pictures made by the same rule.
WeightTerms learning_of(WeightTerms terms, PixelRule rule) {
  terms.edges = rule == PixelRule::kEdges;
  return terms;
}

// The samples of one picture on their triangulation.
class MeshPainter {
 public:
  MeshPainter(const Subject& subject, const WeightTerms& terms, PixelRule rule)
      : camera_(subject.camera),
        tracer_(tracer_of(subject)),
        mesh_(Region::whole({camera_.width, camera_.height, kTilePixels}), learning_of(terms, rule)),
        rule_(rule),
        projected_shapes_(
            [this](std::uint32_t primitive, ImageShape& shape) { tracer_.project(primitive, shape); }) {}

  void add(const Vec2d& point) {
    Sample sample;
    sample.x = point.x, sample.y = point.y;
    sample.ray = tracer_.trace(point.x, point.y);
    mesh_.insert(sample);
  }

  void clear() { mesh_.clear(); }

  enum class Stop : std::uint8_t { kSamples, kTime, kExhausted };

  // Refines until there are `samples` samples, the thread's CPU time is `end_s`, or nothing is left to
  // refine.
  Stop refine_until(double samples, double end_s) {
    constexpr int kSamplesPerLook = 256;  // reading the clock costs as much as a sample
    for (int i = 1; static_cast<double>(mesh_.samples().size()) < samples; ++i) {
      if (i % kSamplesPerLook == 1)
        mesh_.expect_growth(samples / static_cast<double>(mesh_.samples().size()));
      if (i % kSamplesPerLook == 0 && thread_cpu_seconds() > end_s) return Stop::kTime;
      const std::optional<Refinement> next = mesh_.next_point();
      if (!next) return Stop::kExhausted;
      add(next->point);
    }
    return Stop::kSamples;
  }

  double density() const { return samples_per_pixel(static_cast<double>(mesh_.samples().size()), camera_); }

  Image picture() {
    projected_shapes_.forget();  // as every frame must
    reconstruct(mesh_, mesh_.region().bounds(), pixels_, buffers_, rule_, &projected_shapes_);
    Image image;
    image.width = camera_.width, image.height = camera_.height;
    image.pixels = std::exchange(pixels_.colors, {});
    return image;
  }

 private:
  Camera camera_;
  Tracer tracer_;
  SampleMesh mesh_;
  PixelRule rule_;
  ProjectedShapeCache projected_shapes_;
  PixelBlock pixels_;
  ReconstructionBuffers buffers_;
};

// Returns the task's densities that a method can have whose coarsest picture has this one.
std::vector<double> densities_from(double coarsest, const CurveTask& task) {
  const auto begin = std::lower_bound(task.densities.begin(), task.densities.end(), coarsest);
  std::vector<double> densities(begin, task.densities.end());
  if (task.takes_coarsest && begin != task.densities.begin()) densities.insert(densities.begin(), coarsest);
  return densities;
}

// Makes one refinement, with a picture at each density. A picture's time is that of all sampling before it
// and of its own reconstruction. The refinement is made twice and the second counts: the frames of a
// sequence, too, find the storage of those before them.
void run_refinement(const WeightTerms& terms, PixelRule rule, const CurveTask& task) {
  const Camera& camera = task.subject.camera;
  const double pixels = static_cast<double>(camera.width) * camera.height;
  const std::vector<Vec2d> seeds = seed_points(camera.width, camera.height, task.seed);
  MeshPainter painter(task.subject, terms, rule);
  for (const Vec2d& point : seeds) painter.add(point);
  painter.refine_until(task.densities.back() * pixels, thread_cpu_seconds() + task.limit_s);
  painter.picture();
  painter.clear();

  double sampling = 0, begin = thread_cpu_seconds();
  for (const Vec2d& point : seeds) painter.add(point);
  for (const double density : densities_from(painter.density(), task)) {
    const auto stop = painter.refine_until(density * pixels, begin + task.limit_s - sampling);
    const double sampled = thread_cpu_seconds();
    sampling += sampled - begin;
    Image image = painter.picture();
    const double seconds = sampling + thread_cpu_seconds() - sampled;
    task.sink({painter.density(), seconds, std::move(image), stop == MeshPainter::Stop::kExhausted});
    if (stop != MeshPainter::Stop::kSamples || seconds > task.limit_s) return;
    begin = thread_cpu_seconds();
  }
}

Method refinement(std::string name, std::string description, const WeightTerms& terms,
                  PixelRule rule = PixelRule::kEdges) {
  return {std::move(name), std::move(description),
          [=](const CurveTask& task) { run_refinement(terms, rule, task); }};
}

void run_stratified(const CurveTask& task) {
  const double w = task.subject.camera.width, h = task.subject.camera.height;
  run_grids(task, [&](const Size& size) {
    std::mt19937_64 random(task.seed);
    const auto jitter = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    const double begin = thread_cpu_seconds();
    MeshPainter painter(task.subject, {.area = false, .variance = false, .learned = false},
                        PixelRule::kEdges);
    for (const Vec2d& corner : {Vec2d(0, 0), Vec2d(w, 0), Vec2d(w, h), Vec2d(0, h)}) painter.add(corner);
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        const double px = (x + jitter()) * w / size.width;
        painter.add({px, (y + jitter()) * h / size.height});
      }
    }
    Image image = painter.picture();
    return Rendering{painter.density(), thread_cpu_seconds() - begin, std::move(image)};
  });
}

std::string word_of(const Method& method) {
  std::string word = method.name;
  std::replace(word.begin(), word.end(), ' ', '-');
  return word;
}

// A sampler of pprt-render, made as a rank alone makes it: what it knows of the scene counts.
class SamplerPicture {
 public:
  SamplerPicture(const Subject& subject, SamplerChoice choice)
      : camera_(subject.camera),
        tracer_(tracer_of(subject)),
        probe_(probe_of(tracer_)),
        made_(make_sampler(settings_of(subject, choice), undivided(camera_), 0, probe_)),
        seeds_(made_.sampler->seeds()) {}

  SamplerPicture(SamplerPicture&&) = delete;  // the probe refers to the tracer

  // The least density: with fewer samples parts of the picture would be black.
  double least_density() const { return samples_per_pixel(static_cast<double>(seeds_.size()), camera_); }

  // Makes the picture anew from so many samples, or fewer when nothing is worth more.
  Rendering render(double density) {
    constexpr std::size_t kSamplesPerHint = 64, kAtOnce = 16;
    const double begin = thread_cpu_seconds();
    const double samples = density * camera_.width * camera_.height;
    Sampler& sampler = *made_.sampler;
    sampler.clear(false);
    for (const SeedPoint& seed : seeds_) sampler.insert(trace(seed.at));
    sampler.expect_growth(std::max(1.0, samples / static_cast<double>(sampler.size())));
    bool is_exhausted = false;
    std::size_t next_hint = sampler.size() + kSamplesPerHint;
    std::vector<Sample> traced;
    while (static_cast<double>(sampler.size()) < samples && !is_exhausted) {
      if (sampler.size() >= next_hint) {
        sampler.expect_growth(samples / static_cast<double>(sampler.size()));
        next_hint = sampler.size() + kSamplesPerHint;
      }
      const double left = std::ceil(samples - static_cast<double>(sampler.size()));
      traced.clear();
      for (const Vec2d& point : sampler.next_points(std::min(kAtOnce, static_cast<std::size_t>(left))))
        traced.push_back(trace(point));
      for (const Sample& sample : traced) sampler.insert(sample);
      is_exhausted = traced.empty();
    }
    sampler.paint({}, pixels_);
    Image image;
    image.width = camera_.width, image.height = camera_.height;
    image.pixels = std::exchange(pixels_.colors, {});
    return {samples_per_pixel(static_cast<double>(sampler.size()), camera_), thread_cpu_seconds() - begin,
            std::move(image), is_exhausted};
  }

 private:
  static SessionSettings settings_of(const Subject& subject, SamplerChoice choice) {
    return {
        .width = subject.camera.width, .height = subject.camera.height, .sampler = choice, .is_still = true};
  }
  static Partition undivided(const Camera& camera) {
    const TileGrid grid(camera.width, camera.height, kTilePixels);
    return bisect(grid, std::vector<double>(static_cast<std::size_t>(grid.tile_count()), 1), 1);
  }

  Sample trace(const Vec2d& point) const {
    Sample sample;
    sample.x = point.x, sample.y = point.y;
    const double footprint = probe_.has_textures ? std::min(1.0, made_.sampler->footprint(point)) : 1;
    sample.ray = probe_.trace_knowing(point.x, point.y, {}, footprint);
    return sample;
  }

  Camera camera_;
  Tracer tracer_;
  Probe probe_;
  SamplerWithExchange made_;
  std::vector<SeedPoint> seeds_;
  PixelBlock pixels_;
};

// The last picture is made before all others, too: the frames of a sequence find the storage of those before
// them.
void run_default(const CurveTask& task) {
  SamplerPicture picture(task.subject, SamplerChoice::kAuto);
  picture.render(task.densities.back());
  for (const double density : densities_from(picture.least_density(), task)) {
    Rendering rendering = picture.render(density);
    const bool is_last = rendering.exhausted || rendering.seconds > task.limit_s;
    task.sink(std::move(rendering));
    if (is_last) return;
  }
}

}  // namespace

Method default_method() {
  return {kDefaultMethod,
          "this renderer's default: what is visible, then nodes of a lattice where the picture is expected "
          "to be wrong",
          run_default};
}

Method delaunay_method() {
  return refinement(kDelaunayMethod, "--sampler delaunay: the heaviest triangle is refined", {});
}

Method uniform_method() {
  return {kUniform, "a grid of samples: bilinear where coarser than pixels, mean over the pixel where finer",
          run_uniform};
}

Image uniform_picture_in(double seconds, const Subject& subject) {
  constexpr int kTrials = 3;  // each finds the density for the next
  double density = 0.05;      // samples per pixel
  Image image;
  for (int trial = 0; trial < kTrials; ++trial) {
    Tracer tracer = tracer_of(subject);
    const double begin = thread_cpu_seconds();
    image = uniform_picture(tracer, subject.camera, grid_size(subject.camera, density));
    density *= seconds / std::max(thread_cpu_seconds() - begin, 1e-9);
  }
  return image;
}

std::vector<Method> accuracy_methods() {
  return {default_method(),
          uniform_method(),
          {kControl, "the uniform method again: its difference to the first is noise", run_uniform},
          delaunay_method(),
          refinement("paper weights", "delaunay with the paper's weights, nothing learned from errors found",
                     {.learned = false}),
          refinement("area only", "paper weights without the variance of colours",
                     {.variance = false, .pixel_rule = false, .learned = false}),
          refinement("variance only", "paper weights without the area", {.area = false, .learned = false}),
          refinement("no pixel rule", "paper weights; flat triangles below a pixel are refined like others",
                     {.pixel_rule = false, .learned = false}),
          refinement("pixel area",
                     "delaunay; a pixel with several samples shows the interpolation's mean over its area",
                     {}, PixelRule::kArea),
          refinement("mean of samples",
                     "delaunay; a pixel with several samples shows their mean, as in the paper", {},
                     PixelRule::kMean),
          refinement("pixel centers", "delaunay; every pixel shows the interpolation at its centre", {},
                     PixelRule::kCenter),
          {"stratified random", "no queue: a jittered grid, triangulated and reconstructed alike",
           run_stratified}};
}

std::vector<std::string> method_words() {
  std::vector<std::string> words;
  for (const Method& method : accuracy_methods()) words.push_back(word_of(method));
  return words;
}

std::vector<Method> methods_of(std::string_view list) {
  const std::vector<std::string> words = method_words();
  const std::vector<std::string_view> known(words.begin(), words.end());
  std::set<std::string_view> asked = {kUniform, kControl};
  for (const std::string_view word : words_in_list("--methods", list, known)) asked.insert(word);
  std::vector<Method> methods = accuracy_methods();
  std::erase_if(methods, [&](const Method& method) { return !asked.contains(word_of(method)); });
  return methods;
}

std::vector<double> curve_densities() {
  std::vector<double> densities;
  for (int i = -12; i <= 2; ++i) densities.push_back(std::pow(10.0, i / 5.0));
  densities.insert(densities.end(), {4.2, 7, 11});
  return densities;
}

}  // namespace pprt
