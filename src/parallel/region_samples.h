// What a sampler is to the worker. It holds the samples that one rank knows of a picture, and wants the next
// point. It knows which samples other ranks need, and makes pixels of all. MeshSamples is the paper's
// sampler, LatticeSamples the one of docs/decisions/0021-lattice.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/camera.h"
#include "parallel/balance/partition.h"
#include "pipeline/preparation/casting.h"
#include "pipeline/reconstruction/reconstruction.h"
#include "pipeline/region_quality.h"
#include "pipeline/sample.h"

namespace pprt {

// An image point at which a picture's first samples are taken, pixels.
struct SeedPoint {
  Vec2d at;
  std::uint32_t number = 0;  // of the seed
  bool own = false;          // it lies in the region
};

// A resting camera accumulates no more: further samples change a pixel by less than a display step, and each
// costs time in every reconstruction to come.
inline constexpr std::size_t kMostSamplesPerPixel = 16;

// What the picture shows before a sample refines it.
struct PictureGuess {
  Color color;
  double area = 0;  // that the sample will stand for, square pixels
};

// What becomes of cast samples.
enum class CastUse : std::uint8_t {
  kInserted,  // samples of the picture, if they are visible
  kNearby     // they tell which lights are seen near them
};

class RegionSamples {
 public:
  virtual ~RegionSamples() = default;

  // --- A picture begins

  // Removes all samples. `keep_learned`: keeps what refinement has learned from them, for a picture much like
  // the one before.
  virtual void clear(bool keep_learned) = 0;

  // The points where every picture is sampled first, those of other regions included that this one needs.
  virtual std::vector<SeedPoint> seeds() const = 0;

  // Inserts the sample of a seed, traced here. False if its point already holds one. Another rank's seed
  // counts as sent by its owner.
  virtual bool insert_seed(const Sample& sample, std::uint32_t number) = 0;

  // --- Samples

  // Returns the image point of the sample that is wanted most, pixels. Empty when none is worth its time. The
  // caller inserts a sample there before it asks again.
  virtual std::optional<Vec2d> next_point() = 0;

  // Returns what the picture shows at next_point(), for a sample on this primitive. Asked only where cast
  // samples are inserted, for their worth is judged by it.
  virtual PictureGuess guess(std::uint32_t /*primitive*/) const { return {}; }

  // Inserts a sample; false if its point already holds one or cannot hold one. `from`: the rank that sent it,
  // or this one.
  virtual bool insert(const Sample& sample, int from) = 0;

  // Returns the lights that cast samples near a point know.
  virtual std::span<const KnownLights> known_lights(const Vec2d& /*point*/) { return {}; }

  virtual CastUse cast_use() const { return CastUse::kInserted; }

  // Takes in this rank's cast samples. Calls done(sample, whether it was inserted) after each one.
  using Inserted = std::function<void(const Sample& sample, bool is_new)>;
  virtual void insert_cast(std::span<const Sample> samples, const Inserted& done) = 0;

  // Hint: the frame will end with `factor` times the current samples.
  virtual void expect_growth(double factor) = 0;

  // --- Exchange

  // Finds the samples that others need among those inserted since the last call. Returns how often the
  // update rule was applied.
  virtual std::size_t announce() = 0;

  // Returns the samples to send to `rank`, and empties that outbox.
  virtual std::vector<Sample> take_outbox(int rank) = 0;

  // Sends `taker` what it must know of these tiles. Call it before the tiles are the taker's.
  virtual void introduce(std::span<const int> tiles, int taker) = 0;

  // A tile was transferred to this rank, but it has another owner already. What has been sent because of it,
  // and will be, is forwarded to that owner.
  virtual void forward_tile(int tile) = 0;

  // Tiles have new owners; samples stay. What others still send because of tiles given away is forwarded.
  virtual void repartition(const Partition& partition) = 0;

  // The same for tiles that changed hands one by one. Returns whether own tiles came or went.
  virtual bool transfer(const Partition& partition) = 0;

  // Number of samples of each tile that `rank` is known to know.
  virtual std::vector<std::uint32_t> known_in_tiles(int rank) const = 0;

  virtual const Partition& partition() const = 0;

  // Other ranks that this one sends a picture's first samples or gets them from; ascending, symmetric.
  virtual const std::vector<int>& seed_peers() const = 0;

  // Other ranks that have a tile beside one of the own ones; ascending.
  virtual const std::vector<int>& neighbours() const = 0;

  // --- Readings

  virtual std::size_t size() const = 0;  // number of samples, other ranks' included

  // Returns the samples. A still that nobody else needs samples of does not keep them: then there are none.
  virtual std::span<const Sample> samples() const = 0;
  virtual const Region& region() const = 0;

  // How far the region is refined, until the next call or change.
  virtual RegionQuality quality() = 0;

  // Whether the region's mean weight is at most `quality`.
  virtual bool is_refined_to(double quality) = 0;

  // Casts the region's samples; see cast_samples().
  virtual CastResult cast(const Camera& next, int next_frame, const CastSettings& settings) const = 0;

  // The probe looks from another camera.
  virtual void camera_changed() = 0;

  // Replaces `pixels` by those of the region, and of further tiles that the samples cover.
  virtual void paint(std::span<const std::int32_t> further_tiles, RegionPixels& pixels) = 0;

  // Brings tiles of the region up to date in what paint() has made of it. After each one it asks whether time
  // is over, and returns how many there were. A mesh does all at once.
  virtual std::size_t repaint(std::span<const std::int32_t> tiles, const std::function<bool()>& is_over,
                              RegionPixels& pixels) = 0;
};

}  // namespace pprt
