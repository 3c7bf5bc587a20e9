#include "unit/parallel/virtual_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <deque>
#include <limits>
#include <mutex>
#include <random>
#include <span>
#include <thread>
#include <utility>

#include "parallel/clock/host_time.h"
#include "parallel/network/local_communicator.h"

namespace pprt {
namespace {

constexpr double kPlaneDistance = 10;
constexpr double kDiscRadius = 3;

// The probe of one rank.
class DiscTracer {
 public:
  DiscTracer(const Conditions& conditions, int rank, int rehearsals)
      : conditions_(conditions), rank_(rank), random_(static_cast<unsigned>(rank)), frame_(-rehearsals) {}

  Probe probe() {
    Probe probe = {[this](const Camera& camera) {
                     camera_ = camera;
                     if (++frame_ == 3 && rank_ == conditions_.sleeper) {
                       std::this_thread::sleep_for(std::chrono::duration<double>(conditions_.sleeps_s));
                     }
                   },
                   [this](double x, double y) { return trace(x, y); },
                   [](const Vec3f&, bool) { return true; },
                   [this] { return counts_; },
                   conditions_.tells_shapes ? [this](std::uint32_t p, ImageShape& shape) { view(p, shape); }
                                            : std::function<void(std::uint32_t, ImageShape&)>(),
                   conditions_.tells_shapes ? 2U : 0U,
                   [this](double x, double y, std::span<const KnownLights> known, double footprint) {
                     return trace(x, y, known, footprint);
                   }};
    probe.has_textures = true;  // footprints are noted
    return probe;
  }

  std::vector<Traced> take_traced() { return std::move(traced_); }

 private:
  // The disc as a quadric that is a little nearer than the plane, which is all that there is besides.
  void view(std::uint32_t primitive, ImageShape& shape) const {
    const Vec3d origin = camera_.eye + ray_direction(camera_, 0, 0) * kPlaneDistance;
    const double step = camera_.slope_per_pixel * kPlaneDistance;  // x to the right, y downwards
    shape = {};
    if (primitive == 1) {
      shape.kind = ImageShape::Kind::kQuadric;
      const double per_x = camera_.right.x * step, per_y = -camera_.up.y * step;
      constexpr double kDepth = 1e-6;
      shape.quadric.discriminant = {
          kDepth * (kDiscRadius * kDiscRadius - origin.x * origin.x - origin.y * origin.y),
          kDepth * -2 * origin.x * per_x,
          kDepth * -2 * origin.y * per_y,
          kDepth * -per_x * per_x,
          0,
          kDepth * -per_y * per_y};
      shape.quadric.middle = {-2 / kPlaneDistance, 0, 0};
    } else {
      constexpr float kFar = 1e9F;
      shape.kind = ImageShape::Kind::kFacets;
      shape.facets = {
          {{{{1, 0, 0}, {1, 0, 0}, {1, 0, 0}}}, {1 / kPlaneDistance, 0, 0}, {-kFar, -kFar, kFar, kFar}}};
    }
  }

  // All rays but the first are shadow rays, to as many lights, all of which are seen.
  RaySample trace(double x, double y, std::span<const KnownLights> known = {}, double footprint = 1) {
    traced_.push_back({frame_, x, y, footprint});
    ++counts_.primary;
    const Vec3d hit = camera_.eye + ray_direction(camera_, x, y) * kPlaneDistance;
    const double period = conditions_.period;
    const bool in_disc =
        period > 0 ? std::hypot(std::remainder(hit.x, period), std::remainder(hit.y, period)) < 0.3 * period
                   : std::hypot(hit.x, hit.y) < kDiscRadius;
    RaySample sample;
    sample.hit = Vec3f(hit);
    sample.color = in_disc ? Color(0.9f, 0.7f, 0.2f) : Color(0.1f, 0.1f, 0.3f);
    sample.primitive = in_disc ? 1 : 2;
    sample.rays = (in_disc ? 4u : 1u) + static_cast<std::uint32_t>(conditions_.more_rays);
    const auto lights = static_cast<std::uint8_t>((1U << std::min(sample.rays - 1, 8U)) - 1);
    sample.lights = {lights, lights};
    for (const KnownLights& at : known)
      if (at.primitive == sample.primitive && at.lights.asked == lights) sample.rays = 1;
    counts_.shadow += sample.rays - 1;
    if (conditions_.no_number_every > 0 &&
        traced_.size() % static_cast<std::size_t>(conditions_.no_number_every) == 0) {
      sample.color.x = std::numeric_limits<float>::quiet_NaN();
    }
    if (conditions_.slow_at_random && random_() % 256 == 0) {
      std::this_thread::sleep_for(std::chrono::microseconds(random_() % 2000));
    }
    return sample;
  }

  Conditions conditions_;
  int rank_;
  std::mt19937 random_;
  Camera camera_;
  RayCounts counts_;
  int frame_;
  std::vector<Traced> traced_;
};

// All bundles that were sent in a run.
class Log {
 public:
  void add(SentBundle bundle) {
    const std::lock_guard lock(mutex_);
    bundles_.push_back(std::move(bundle));
  }
  void add(SentPixels pixels) {
    const std::lock_guard lock(mutex_);
    pixels_.push_back(std::move(pixels));
  }
  void fail(int rank, const std::string& what) {
    const std::lock_guard lock(mutex_);
    error_ += "rank " + std::to_string(rank) + ": " + what + "\n";
  }
  std::vector<SentBundle> take_bundles() { return std::move(bundles_); }
  std::vector<SentPixels> take_pixels() { return std::move(pixels_); }
  std::string error() const { return error_; }

 private:
  std::mutex mutex_;
  std::vector<SentBundle> bundles_;
  std::vector<SentPixels> pixels_;
  std::string error_;
};

// Ends the thread of a rank that nobody hears any more.
struct Unplugged {};

class WatchedCommunicator final : public Communicator {
 public:
  WatchedCommunicator(LocalNetwork& network, int rank, const Conditions& conditions, Log& log)
      : inner_(network, rank), conditions_(conditions), log_(log), random_(static_cast<unsigned>(rank + 1)) {}

  int rank() const override { return inner_.rank(); }
  int size() const override { return inner_.size(); }
  int ranks_on_host() const override { return inner_.ranks_on_host(); }
  int cores_on_host() const override { return inner_.cores_on_host(); }
  void send(int to, Tag tag, Bytes payload) override {
    if (is_unplugged()) return;
    if (tag == Tag::kBundle) {
      Bundle bundle = decode_bundle(payload);
      if (conditions_.drop_samples) {
        bundle.samples.clear();
        payload = encode(bundle);
      }
      log_.add({rank(), to, std::move(bundle)});
    }
    if (tag == Tag::kPixels) {
      const PixelMessage message = decode_pixels(payload);
      SentPixels sent{rank(), message.frame_index, {}, message.given};
      for (const TileReport& tile : message.tiles) sent.tiles.push_back(tile.tile);
      log_.add(std::move(sent));
    }
    inner_.send(to, tag, std::move(payload));
  }
  std::optional<Message> receive() override {
    if (is_unplugged()) throw Unplugged();
    if (conditions_.arrive_at_random && random_() % 2 == 0) return look();
    std::optional<Message> message = inner_.receive();
    if (conditions_.bundle_delay_s > 0) message = delayed(std::move(message));
    return message ? (last_arrival_s_ = monotonic_seconds(), message) : look();
  }
  void rest(double at_most_s, std::size_t messages) override {
    inner_.rest(std::min(at_most_s, kLongestRest), messages);
  }
  void give_up(int rank) override { inner_.give_up(rank); }
  void finish() override { inner_.finish(); }

 private:
  bool is_unplugged() const {
    return conditions_.unplugged.contains(rank()) &&
           monotonic_seconds() > began_s_ + conditions_.unplugged_at_s;
  }

  std::optional<Message> look() const {
    if (monotonic_seconds() - last_arrival_s_ > conditions_.patience_s) {
      throw std::runtime_error("waited in vain for a message");
    }
    return std::nullopt;
  }

  // Bundles take their time; everything else passes them by.
  std::optional<Message> delayed(std::optional<Message> message) {
    const double now = monotonic_seconds();
    if (message && message->tag == Tag::kBundle) {
      on_their_way_.emplace_back(now + conditions_.bundle_delay_s, std::move(*message));
      message.reset();
    }
    if (message || on_their_way_.empty() || on_their_way_.front().first > now) return message;
    message = std::move(on_their_way_.front().second);
    on_their_way_.pop_front();
    return message;
  }

  static constexpr double kLongestRest = 150e-6;  // seconds: what is held back here wakes nobody

  LocalCommunicator inner_;
  std::deque<std::pair<double, Message>> on_their_way_;  // with the time when each is seen
  Conditions conditions_;
  Log& log_;
  std::mt19937 random_;
  double began_s_ = monotonic_seconds();
  double last_arrival_s_ = began_s_;
};

}  // namespace

Camera camera_before_disc(int width, int height, double shift) {
  Camera camera;
  camera.slope_per_pixel = 1.0 / height;
  camera.width = width, camera.height = height;
  camera.eye.x = shift * camera.slope_per_pixel * kPlaneDistance;
  return camera;
}

CameraSource still_or_pan(const SessionSettings& settings, int frames, double shift) {
  return [=, width = settings.width, height = settings.height](int index) -> std::optional<FrameRequest> {
    if (index >= frames) return std::nullopt;
    return FrameRequest{index + 1, camera_before_disc(width, height, index * shift), false};
  };
}

VirtualRun run_session(int ranks, const SessionSettings& settings, const CameraSource& source,
                       const Conditions& conditions) {
  VirtualRun run;
  run.traced.resize(static_cast<std::size_t>(ranks));
  Log log;
  LocalNetwork network(ranks);
  const auto rank_body = [&](int rank) {
    WatchedCommunicator communicator(network, rank, conditions, log);
    const bool rehearses = settings.clock == ClockKind::kWall && settings.frames_per_second > 0;
    DiscTracer tracer(conditions, rank, rehearses ? kRehearsals : 0);
    const double apart = conditions.clocks_differ ? 1 : 0;
    try {
      if (rank == 0) {
        run_as_master(communicator, settings, tracer.probe(), source,
                      [&](FinishedFrame&& frame) { run.frames.push_back(std::move(frame)); },
                      {.loss = conditions.loss, .is_enough = conditions.is_enough});
      } else {
        run_as_worker(communicator, settings, tracer.probe(),
                      [&] { return monotonic_seconds() * (1 + 2e-4 * apart * rank) + 1e5 * apart * rank; });
      }
    } catch (const Unplugged&) {
    } catch (const std::exception& e) {
      log.fail(rank, e.what());
    }
    run.traced[static_cast<std::size_t>(rank)] = tracer.take_traced();
  };
  std::vector<std::thread> threads;
  for (int rank = 0; rank < ranks; ++rank) threads.emplace_back(rank_body, rank);
  for (std::thread& thread : threads) thread.join();
  run.bundles = log.take_bundles();
  run.pixels = log.take_pixels();
  run.error = log.error();
  return run;
}

double unevenness(const FinishedFrame& frame) {
  double sum = 0, squares = 0;
  for (const RankReport& r : frame.ranks) sum += r.mean_weight, squares += r.mean_weight * r.mean_weight;
  const auto n = static_cast<double>(frame.ranks.size());
  return std::sqrt(std::max(0.0, squares / n - sum * sum / n / n)) / (sum / n);
}

bool same_pictures(const VirtualRun& a, const VirtualRun& b) {
  if (a.frames.size() != b.frames.size()) return false;
  for (std::size_t i = 0; i < a.frames.size(); ++i) {
    const std::vector<Color>&p = a.frames[i].image.pixels, &q = b.frames[i].image.pixels;
    if (p.size() != q.size() || std::memcmp(p.data(), q.data(), p.size() * sizeof(Color)) != 0) return false;
  }
  return true;
}

}  // namespace pprt
