#include "pipeline/sample_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipeline/sample_mesh_impl.h"

namespace pprt {

SampleMesh::SampleMesh(const Region& region, const WeightTerms& terms)
    : impl_(std::make_unique<Impl>(region, terms)) {}
SampleMesh::SampleMesh(SampleMesh&&) noexcept = default;
SampleMesh& SampleMesh::operator=(SampleMesh&&) noexcept = default;
SampleMesh::~SampleMesh() = default;

void SampleMesh::clear() {
  impl_->clear();
}
void SampleMesh::set_region(const Region& region) {
  impl_->set_region(region);
}
void SampleMesh::note_foreign() {
  impl_->note_foreign();
}
const Region& SampleMesh::region() const {
  return impl_->region();
}
bool SampleMesh::insert(const Sample& sample) {
  return impl_->insert(sample);
}
std::optional<Vec2d> SampleMesh::next_point() {
  return impl_->next_point();
}
Color SampleMesh::guess() const {
  return impl_->guess();
}
std::span<const Sample> SampleMesh::samples() const {
  return impl_->samples();
}
void SampleMesh::take_new_at_border(std::vector<BorderTriangle>& triangles) {
  impl_->take_new_at_border(triangles);
}
std::span<const TileWeights> SampleMesh::tile_weights() const {
  return impl_->tile_weights();
}
double SampleMesh::refinement() const {
  return impl_->refinement();
}

SampleMesh::Impl::Impl(const Region& region, const WeightTerms& terms) : region_(region), terms_(terms) {
  clear();
}

void SampleMesh::Impl::clear() {
  const auto tiles = static_cast<std::size_t>(region_.grid().tile_count());
  delaunay_.clear();
  samples_.clear();
  new_at_border_.clear();
  queue_.clear();
  tile_weights_.assign(tiles, {});
  region_weights_ = {};
  latest_in_tile_.assign(tiles, Vertex());
  next_stamp_ = 1;
  planar_ = notes_foreign_ = false;
  wanted_.reset();
}

void SampleMesh::Impl::set_region(const Region& region) {
  region_ = region;
  for (auto v = delaunay_.finite_vertices_begin(); v != delaunay_.finite_vertices_end(); ++v)
    v->info().own = region_.owns_point(v->point().x(), v->point().y());
  if (planar_) rescan();
}

bool SampleMesh::Impl::insert(const Sample& sample) {
  const TileGrid& grid = region_.grid();
  if (!(sample.x >= 0 && sample.x <= grid.width && sample.y >= 0 && sample.y <= grid.height)) return false;
  const Vec2d point(sample.x, sample.y);
  const Location at = wanted_ == point ? wanted_location_ : locate(point, face_near(point));
  wanted_.reset();
  const std::size_t before = delaunay_.number_of_vertices();
  const Vertex vertex = delaunay_.insert({point.x, point.y}, at.type, at.face, at.index);
  if (delaunay_.number_of_vertices() == before) return false;
  const int tile = grid.tile_at(point.x, point.y);
  vertex->info() = {static_cast<std::uint32_t>(samples_.size()), sample.ray.color, region_.owns_tile(tile)};
  samples_.push_back(sample);
  latest_in_tile_[static_cast<std::size_t>(tile)] = vertex;

  if (delaunay_.dimension() < 2) return true;
  if (!planar_) {
    planar_ = true;
    rescan();
    return true;
  }
  // Exactly the triangles around the new vertex are new, and the objects of all that died are among them.
  auto face = delaunay_.incident_faces(vertex);
  const auto first = face;
  do {
    forget(face->info());
    if (delaunay_.is_infinite(face)) continue;
    note_at_border(face, adopt(face));
  } while (++face != first);
  return true;
}

void SampleMesh::Impl::note_at_border(Face face, const Circle& circle) {
  const auto info = [&](int i) -> const VertexInfo& { return face->vertex(i)->info(); };
  const std::array<bool, 3> own = {info(0).own, info(1).own, info(2).own};
  if (!own[0] && !own[1] && !own[2] && !notes_foreign_) return;
  if (region_.surely_holds(circle)) return;
  new_at_border_.push_back(
      {{face, face->info().stamp}, {circle, {info(0).sample, info(1).sample, info(2).sample}, own}});
}

std::optional<Vec2d> SampleMesh::Impl::next_point() {
  while (const std::optional<QueueEntry> entry = queue_.pop()) {
    const Face face = entry->face;
    if (face->info().stamp != entry->stamp) continue;  // destroyed since it was queued
    const Vec2d center =
        triangle_shape(corner(face, 0), corner(face, 1), corner(face, 2)).circumcircle.center;
    const Vec2d point = refinement_point(face, center);
    const Location at = locate(point, face);
    if (at.type == Delaunay::VERTEX) continue;  // rounded onto a sample: as fine as coordinates allow
    refined_ = face;
    wanted_ = point;
    wanted_location_ = at;
    return point;
  }
  return std::nullopt;
}

void SampleMesh::Impl::take_new_at_border(std::vector<BorderTriangle>& triangles) {
  triangles.clear();
  for (const BorderEntry& b : new_at_border_) {
    if (b.entry.face->info().stamp == b.entry.stamp) triangles.push_back(b.triangle);
  }
  new_at_border_.clear();
}

SampleMesh::Impl::Location SampleMesh::Impl::locate(const Vec2d& point, Face near) const {
  Location at;
  at.face = delaunay_.locate({point.x, point.y}, at.type, at.index, near);
  return at;
}

SampleMesh::Impl::Face SampleMesh::Impl::face_near(const Vec2d& point) const {
  const Vertex vertex = latest_in_tile_[static_cast<std::size_t>(region_.grid().tile_at(point.x, point.y))];
  return vertex == Vertex() ? Face() : vertex->face();
}

Circle SampleMesh::Impl::adopt(Face face) {
  const TriangleShape shape = triangle_shape(corner(face, 0), corner(face, 1), corner(face, 2));
  const VertexInfo &a = face->vertex(0)->info(), &b = face->vertex(1)->info(), &c = face->vertex(2)->info();
  const Vec2d point = refinement_point(face, shape.circumcircle.center);

  FaceInfo& info = face->info();
  info.stamp = next_stamp_++;
  info.tile = region_.grid().tile_at(point.x, point.y);
  // What is refined elsewhere is weighed elsewhere.
  if (region_.owns_tile(info.tile)) {
    info.weight = refinement_weight(shape, display_variance(a.color, b.color, c.color), terms_);
    count(info, 1);
    if (info.weight > 0) queue_.push(info.weight, {face, info.stamp});
  }
  return shape.circumcircle;
}

void SampleMesh::Impl::forget(FaceInfo& info) {
  if (info.stamp == 0) return;
  if (region_.owns_tile(info.tile)) count(info, -1);
  info.stamp = 0;
}

void SampleMesh::Impl::count(const FaceInfo& info, int sign) {
  const auto change = [&](TileWeights& weights) {
    weights.triangles += sign;
    // The last triangle takes the rounding of the running sum with it.
    weights.total_weight = weights.triangles == 0 ? 0 : weights.total_weight + sign * info.weight;
  };
  change(tile_weights_[static_cast<std::size_t>(info.tile)]);
  change(region_weights_);
}

void SampleMesh::Impl::rescan() {
  queue_.clear();
  wanted_.reset();
  tile_weights_.assign(tile_weights_.size(), {});
  region_weights_ = {};
  for (auto face = delaunay_.finite_faces_begin(); face != delaunay_.finite_faces_end(); ++face) adopt(face);
}

Vec2d SampleMesh::Impl::refinement_point(Face face, const Vec2d& circumcenter) const {
  const double width = region_.grid().width, height = region_.grid().height;
  const auto inside = [](double v, double limit) { return v >= 0 && v <= limit; };
  if (inside(circumcenter.x, width) && inside(circumcenter.y, height)) return circumcenter;
  // From the centroid, which is inside both image and circumcircle, towards the circumcentre: every point of
  // the way is inside the circle too, so a sample there does destroy the triangle.
  const Vec2d start = (corner(face, 0) + corner(face, 1) + corner(face, 2)) / 3.0;
  const Vec2d way = circumcenter - start;
  double share = 1;
  Vec2d exit = circumcenter;
  const auto meet = [&](double from, double step, double border, int axis) {
    const double t = (border - from) / step;
    if (!(t < share)) return;
    share = t;
    exit = start + way * t;
    exit[axis] = border;  // exactly, so that points on a border are exactly collinear and make no slivers
  };
  if (circumcenter.x < 0) meet(start.x, way.x, 0, 0);
  if (circumcenter.x > width) meet(start.x, way.x, width, 0);
  if (circumcenter.y < 0) meet(start.y, way.y, 0, 1);
  if (circumcenter.y > height) meet(start.y, way.y, height, 1);
  return {std::clamp(exit.x, 0.0, width), std::clamp(exit.y, 0.0, height)};
}

Vec2d SampleMesh::Impl::corner(Face face, int i) const {
  const auto& p = face->vertex(i)->point();
  return {p.x(), p.y()};
}

std::vector<std::array<std::uint32_t, 3>> triangles(const SampleMesh& mesh) {
  std::vector<std::array<std::uint32_t, 3>> result;
  const auto& delaunay = mesh.impl().delaunay();
  for (auto face = delaunay.finite_faces_begin(); face != delaunay.finite_faces_end(); ++face) {
    result.push_back(
        {face->vertex(0)->info().sample, face->vertex(1)->info().sample, face->vertex(2)->info().sample});
  }
  return result;
}

}  // namespace pprt
