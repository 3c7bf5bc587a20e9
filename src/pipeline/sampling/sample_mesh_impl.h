// Private to the pipeline: the triangulation, and what the mesh knows of its triangles and corners.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "pipeline/sampling/bucket_queue.h"
#include "pipeline/sampling/delaunay.h"
#include "pipeline/sampling/learned_weights.h"
#include "pipeline/sampling/sample_mesh.h"
#include "pipeline/simd.h"

namespace pprt {

class SampleMesh::Impl {
 public:
  using Index = Delaunay::Index;

  // What refinement and reconstruction need of a sample, beside its point.
  struct Corner {
    Color color{0, 0, 0};
    std::uint32_t primitive = 0;  // as in RaySample
    Trait trait = 0;
    bool own = false;  // in the region

    float4 channels() const { return channels_before_more(this); }
  };

  static_assert(offsetof(Corner, primitive) == sizeof(Color));

  Impl(const Region& region, const WeightTerms& terms);

  void clear();
  void restart();
  void set_region(const Region& region);
  void note_foreign() { notes_foreign_ = true; }
  bool insert(const Sample& sample);
  void begin_many() { inserts_many_ = true; }
  void end_many();
  std::optional<Vec2d> next_point();
  void expect_growth(double factor);
  Guess guess(std::uint32_t primitive) const;
  double refinement() const;

  const Region& region() const { return region_; }
  const Delaunay& delaunay() const { return delaunay_; }
  const std::vector<Corner>& corners() const { return corners_; }  // of the same numbers as samples()
  const std::vector<Sample>& samples() const { return samples_; }
  void take_new_at_border(std::vector<BorderTriangle>& triangles);
  const std::vector<TileWeights>& tile_weights() const { return tile_weights_; }

 private:
  // The note of a triangle in the statistics. Its slot then holds another: a new stamp tells them apart, and
  // stamp 0 is a slot whose triangle was never weighed.
  using Tally = Delaunay::Note;
  using Points = std::array<Vec2d, 3>;
  struct QueueEntry {
    Index triangle;
    std::uint32_t stamp;
  };
  static constexpr std::size_t kCellPixels = 8;
  struct BorderEntry {
    QueueEntry entry;
    BorderTriangle triangle;
  };

  bool lives(const QueueEntry& entry) const {
    return delaunay_.triangles()[entry.triangle].note.stamp == entry.stamp;
  }
  std::size_t cell_of(const Vec2d& point) const {
    const auto column = static_cast<std::size_t>(point.x) / kCellPixels;
    const auto row = static_cast<std::size_t>(point.y) / kCellPixels;
    const auto columns = static_cast<std::size_t>(region_.grid().width) / kCellPixels + 1;
    return row * columns + column;
  }
  // A triangle that the point destroys; kNowhere where a sample is already.
  Index find(const Vec2d& point, int tile, bool is_wanted);
  // The square by which the sample shows the picture to be wrong in a triangle that it destroys; and what
  // follows for such triangles from a sample that was wanted there.
  float error_found(Index triangle, const Sample& sample) const;
  void learn(float squared_error, std::uint32_t rays);
  void admit();                                                 // the triangles that an insertion made
  void weigh_new();                                             // them, into weights_
  void adopt(Index triangle);                                   // one that is new: weight, statistics, queue
  void adopt(Index triangle, float weight, TriangleKind kind);  // the same of known weight
  void count(const Tally& tally, int sign);                     // into, or out of, the statistics
  void forget(Tally& tally);                                    // a triangle that is gone: statistics
  void rescan();                                                // every triangle anew
  void note_at_border(Index triangle);
  // What the picture shows of a primitive in the triangle; or of all corners, if it shows no edges or the
  // primitive is none of theirs.
  float4 shown_of(Index triangle, std::uint32_t primitive) const;
  double area(Index triangle) const;  // square pixels
  Vec2d refinement_point(Index triangle) const;
  Points points(Index triangle) const;  // of its corners

  Region region_;
  WeightTerms terms_;
  Delaunay delaunay_;
  std::vector<Sample> samples_;
  std::vector<Corner> corners_;  // one per sample
  std::vector<BorderEntry> new_at_border_;
  std::vector<TileWeights> tile_weights_;
  // Triangles to start a walk from, by tile and by cell of eight pixels; kNowhere before the first.
  std::vector<Index> latest_in_tile_, latest_in_cell_;
  BucketQueue<QueueEntry> queue_;
  LearnedWeights learned_;
  // Of the new triangles, and of the corners around them: weigh_new().
  std::vector<float> weights_;
  std::vector<TriangleKind> kinds_;
  std::vector<float4> shown_;
  std::vector<std::int32_t> primitives_, traits_;
  std::uint32_t next_stamp_ = 1;
  bool notes_foreign_ = false;
  bool inserts_many_ = false;

  // The answer of next_point(), and whose it is: good until anything is inserted.
  std::optional<Vec2d> wanted_;
  Index refined_ = Delaunay::kNowhere;
};

}  // namespace pprt
