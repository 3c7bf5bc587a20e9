// Which samples other ranks need. There are two kinds: for samplers of points (point_exchange.h) and for a
// triangulation (mesh_exchange.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "parallel/balance/partition.h"
#include "pipeline/core/sample.h"

namespace pprt {

// One rank's exchange, kept in step with its sampler: every sample enters the sampler through one of the
// insert functions.
class SampleExchange {
 public:
  SampleExchange() = default;
  SampleExchange(const SampleExchange&) = delete;
  SampleExchange& operator=(const SampleExchange&) = delete;
  virtual ~SampleExchange() = default;

  // The sampler has been emptied: no rank knows a sample of it.
  virtual void clear() = 0;

  // --- Inserting

  // Inserts a sample; false if its point already holds one or cannot hold one. `from`: the rank that sent it,
  // or this one.
  virtual bool insert(const Sample& sample, int from) = 0;

  // Inserts the sample of a seed (Sampler::seeds), traced here. Another rank's seed counts as sent by its
  // owner.
  virtual bool insert_seed(const Sample& sample, std::uint32_t number) = 0;

  // Takes in this rank's cast samples. Calls done(sample, whether it was inserted) after each one.
  using Inserted = std::function<void(const Sample& sample, bool is_new)>;
  virtual void insert_cast(std::span<const Sample> samples, const Inserted& done) = 0;

  // --- Sending

  // Finds the samples that others need among those inserted since the last call. Returns how often the update
  // rule was applied.
  virtual std::size_t announce() = 0;

  // Returns the samples to send to `rank`, and empties that outbox.
  virtual std::vector<Sample> take_outbox(int rank) = 0;

  // Sends `taker` what it must know of these tiles. Call it before the tiles are the taker's.
  virtual void introduce(std::span<const int> tiles, int taker) = 0;

  // A tile was transferred to this rank, but it has another owner already. What has been sent because of it,
  // and will be, is forwarded to that owner as if this rank had had the tile.
  virtual void forward_tile(int tile) = 0;

  // --- Owners

  // Tiles have new owners: the sampler keeps its samples and gets its new region. What others still send
  // because of tiles given away is forwarded until clear().
  virtual void repartition(const Partition& partition) = 0;

  // The same for tiles that changed hands one by one. Returns whether own tiles came or went.
  virtual bool transfer(const Partition& partition) = 0;

  // Returns the number of samples of each tile that `rank` is known to know.
  virtual std::vector<std::uint32_t> known_in_tiles(int rank) const = 0;

  virtual const Partition& partition() const = 0;

  // Other ranks that this one sends a picture's first samples or gets them from; ascending. Symmetric: i is
  // j's peer when j is i's.
  virtual const std::vector<int>& seed_peers() const = 0;

  // Other ranks that have a tile beside one of the own ones; ascending.
  virtual const std::vector<int>& neighbours() const = 0;
};

}  // namespace pprt
