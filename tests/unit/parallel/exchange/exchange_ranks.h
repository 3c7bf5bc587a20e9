// Ranks that exchange samples in one thread: messages arrive when the test wants it, tiles change hands, the
// image is repartitioned and frames begin. What they know in the end is compared with one serial
// triangulation.
#pragma once

#include <deque>
#include <random>
#include <set>
#include <tuple>
#include <vector>

#include "parallel/exchange/mesh_exchange.h"
#include "unit/pipeline/synthetic_image.h"

namespace pprt {

struct MovedTile {
  int tile = 0;
  int owner = 0;
  std::uint64_t version = 0;
};

// What one rank sends another at a time, as a bundle does.
struct ExchangeMessage {
  int frame = 0;       // orders that the sender had carried out; the receiver must have, too
  int begun_in = 0;    // triangulations that it had begun
  bool seeds = false;  // and cast that landed with the receiver
  std::vector<MovedTile> transfers;
  std::vector<Sample> samples;
};

struct ExchangingRank {
  int rank;
  SeedPattern seeds;
  SampleMesh mesh;
  MeshExchange exchange;
  std::vector<std::deque<ExchangeMessage>> inbox;  // per sender, in order of sending
  int frame = 0;
  int begun_in = 0;

  ExchangingRank(const Partition& partition, int its_rank, const SeedPattern& pattern)
      : rank(its_rank),
        seeds(pattern),
        mesh(region_of(partition, its_rank)),
        exchange(mesh, seeds, partition, its_rank),
        inbox(static_cast<std::size_t>(partition.ranks)) {}
};

class ExchangingRanks {
 public:
  ExchangingRanks(const Partition& partition, unsigned seed);

  // As a sequence begins: own seeds and the corners, then those of the others.
  void seed();

  // Each rank refines by a random number of samples, or not at all; most send what others must know.
  void refine(int most);

  // Some messages arrive; some ranks learn of a repartition.
  void deliver_some();

  // The two, one after the other.
  void sample_round(int most) { refine(most), deliver_some(); }

  // A random rank gives some tiles along its border to one neighbour. It may hand on what it has just been
  // given, and regions may fall apart: the exchange does not care.
  void give_somewhere();

  // The image is repartitioned and all samples stay: each rank learns it at a moment of its own.
  void repartition(const Partition& partition);

  // The camera moves by so many pixels: samples move with what they show, some die, and all begin a
  // triangulation with seeds and what is left. A new partition may come with it. With `seeds_late` some ranks
  // go on before all that the others send at first has come.
  void begin_frame(const Vec2d& shift, const Partition* partition, bool seeds_late);

  // Delivers until no message is under way and all ranks know every repartition; returns the number of
  // rounds.
  int quieten();

  const std::deque<ExchangingRank>& ranks() const { return ranks_; }
  int repeats() const { return repeats_; }  // samples that a rank sent another a second time
  int transfers() const { return transfers_; }

  // The serial triangulation of every sample that any rank has.
  SampleMesh all_samples() const;

 private:
  std::size_t random(std::size_t below) { return random_() % below; }
  void post(ExchangingRank& rank, const std::vector<MovedTile>& transfers = {}, bool seeds = false,
            const std::vector<std::vector<Sample>>& guests = {});
  bool take_in_one(ExchangingRank& rank, int from);
  void learn_partition(ExchangingRank& rank);
  void set_partition(ExchangingRank& rank, const Partition& partition);
  void apply(ExchangingRank& rank, const ExchangeMessage& message);
  void take_in_late_seeds(ExchangingRank& rank, const ExchangeMessage& message);
  std::vector<Sample> moved_samples(const ExchangingRank& rank, const Vec2d& shift);
  void trace_seeds(ExchangingRank& rank);
  void take_in_seeds(ExchangingRank& rank, bool some_late);
  void learn_everything();

  Picture picture_;
  std::mt19937 random_;
  std::deque<ExchangingRank> ranks_;
  std::vector<Partition> partitions_;  // in the order of their generations
  std::set<std::tuple<int, int, int, double, double>> sent_;
  int repeats_ = 0;
  int transfers_ = 0;
};

struct Findings {
  int expected = 0;  // triangles of all samples that meet a region, summed over ranks
  int unknown = 0;   // of those: with a corner that the rank does not know
  int wrong = 0;     // triangles of a rank, meeting its region, with a sample well inside their circle
};

// A triangle of the whole triangulation whose corners a rank knows is Delaunay there as well, or one of
// several that four cocircular samples allow.
Findings compare_with_serial(const ExchangingRanks& run);

// Samples that the owner of their tile does not have.
int lost_samples(const ExchangingRanks& run);

// Whether all ranks name the same owners.
bool agree_on_owners(const ExchangingRanks& run);

Partition random_rectangles(const TileGrid& grid, int ranks, unsigned seed);

// Connected regions of ragged outline: each rank grows from a tile of its own.
Partition random_growths(const TileGrid& grid, int ranks, unsigned seed);

}  // namespace pprt
