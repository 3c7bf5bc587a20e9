// Private to the pipeline: the triangulation as CGAL holds it.
#pragma once

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "pipeline/bucket_queue.h"
#include "pipeline/sample_mesh.h"

namespace pprt {

// What the mesh remembers of a triangle while it lives. CGAL reuses the object for other triangles: a new
// stamp tells them apart, and stamp 0 is an object never used.
struct FaceInfo {
  std::uint32_t stamp = 0;
  float weight = 0;
  std::int32_t tile = 0;
};

// What a vertex knows of its sample: all that refinement and reconstruction need, beside its point.
struct VertexInfo {
  std::uint32_t sample = 0;  // index into samples()
  Color color{0, 0, 0};
  bool own = false;  // in the region
};

class SampleMesh::Impl {
 public:
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<VertexInfo, Kernel>;
  using FaceBase = CGAL::Triangulation_face_base_with_info_2<FaceInfo, Kernel>;
  using Delaunay =
      CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>>;
  using Face = Delaunay::Face_handle;
  using Vertex = Delaunay::Vertex_handle;

  Impl(const Region& region, const WeightTerms& terms);

  void clear();
  void set_region(const Region& region);
  void note_foreign() { notes_foreign_ = true; }
  bool insert(const Sample& sample);
  std::optional<Vec2d> next_point();
  Color guess() const {
    return (refined_->vertex(0)->info().color + refined_->vertex(1)->info().color +
            refined_->vertex(2)->info().color) /
           3.0f;
  }
  double refinement() const {
    const auto count = static_cast<double>(region_weights_.triangles);
    return region_weights_.triangles > 0 ? region_weights_.total_weight / count : 0;
  }

  const Region& region() const { return region_; }
  const Delaunay& delaunay() const { return delaunay_; }
  const std::vector<Sample>& samples() const { return samples_; }
  void take_new_at_border(std::vector<BorderTriangle>& triangles);
  const std::vector<TileWeights>& tile_weights() const { return tile_weights_; }

 private:
  struct QueueEntry {
    Face face;
    std::uint32_t stamp;
  };
  struct Location {
    Delaunay::Locate_type type = Delaunay::FACE;
    Face face;
    int index = 0;
  };

  Location locate(const Vec2d& point, Face near) const;
  Face face_near(const Vec2d& point) const;
  Circle adopt(Face face);                     // a triangle that is new: statistics, queue; its circumcircle
  void count(const FaceInfo& info, int sign);  // into, or out of, the statistics
  void forget(FaceInfo& info);                 // a triangle that is gone: statistics
  void rescan();                               // every triangle anew
  void note_at_border(Face face, const Circle& circle);
  Vec2d refinement_point(Face face, const Vec2d& circumcenter) const;
  Vec2d corner(Face face, int i) const;

  Region region_;
  WeightTerms terms_;
  Delaunay delaunay_;
  std::vector<Sample> samples_;
  struct BorderEntry {
    QueueEntry entry;
    BorderTriangle triangle;
  };
  std::vector<BorderEntry> new_at_border_;
  std::vector<TileWeights> tile_weights_;
  TileWeights region_weights_;          // over the region's tiles
  std::vector<Vertex> latest_in_tile_;  // where to start a walk; null handles before the first
  BucketQueue<QueueEntry> queue_;
  std::uint32_t next_stamp_ = 1;
  bool planar_ = false;  // the triangulation has triangles, and they have been scanned
  bool notes_foreign_ = false;

  // The answer of next_point(), located: good until anything is inserted.
  std::optional<Vec2d> wanted_;
  Location wanted_location_;
  Face refined_;  // whose refinement point it is
};

}  // namespace pprt
