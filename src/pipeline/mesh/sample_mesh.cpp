#include "pipeline/mesh/sample_mesh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace pprt {
namespace {

constexpr float kUnknownError = 1.0F / 32;  // of a sample that no triangle predicted
constexpr std::size_t kCellPixels = 8;      // side of a cell that remembers a triangle

bool is_inside(const Vec2d& point, const TileGrid& image) {
  return point.x >= 0 && point.x <= image.width && point.y >= 0 && point.y <= image.height;
}

// Returns where the way to a circumcentre outside the image leaves the image. The way starts at the centroid,
// which is inside both image and circumcircle. So all of it is inside the circle, and a sample at its end
// does destroy the triangle.
Vec2d exit_towards(const Vec2d& circumcenter, const std::array<Vec2d, 3>& corners, const TileGrid& image) {
  const double width = image.width, height = image.height;
  const Vec2d start = (corners[0] + corners[1] + corners[2]) / 3.0;
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

}  // namespace

SampleMesh::SampleMesh(const Region& region, const WeightTerms& terms) : region_(region), terms_(terms) {
  clear();
}

void SampleMesh::clear() {
  restart();
  learned_ = {};
}

void SampleMesh::restart() {
  const auto tiles = static_cast<std::size_t>(region_.grid().tile_count());
  delaunay_.clear();
  samples_.clear();
  corners_.clear();
  new_at_border_.clear();
  queue_.clear();
  queue_.set_floor(std::numeric_limits<float>::infinity());
  tile_weights_.assign(tiles, {});
  all_weights_ = {};
  latest_in_tile_.assign(tiles, Delaunay::kNowhere);
  latest_in_cell_.assign(cell_of({0.0 + region_.grid().width, 0.0 + region_.grid().height}) + 1,
                         Delaunay::kNowhere);
  next_stamp_ = 1;
  notes_foreign_ = false;
  wanted_.reset();
}

void SampleMesh::set_region(const Region& region) {
  region_ = region;
  for (std::size_t i = 0; i < samples_.size(); ++i)
    corners_[i].own = region_.owns_point(samples_[i].x, samples_[i].y);
  enqueue_all_again();
}

// Insertion.

bool SampleMesh::insert(const Sample& sample) {
  return add(sample, true);
}

void SampleMesh::insert_all(std::span<const Sample> samples, const Inserted& done) {
  for (const Sample& s : samples) {
    const bool is_new = add(s, false);
    if (done) done(s, is_new);
  }
  for (Index t = 0; t < delaunay_.triangles().size(); ++t) {
    if (delaunay_.record(t).stamp != 0 || !delaunay_.triangles()[t].is_finite()) continue;
    enqueue(t);
    note_at_border(t);
  }
}

bool SampleMesh::add(const Sample& sample, bool enqueues) {
  const TileGrid& grid = region_.grid();
  const Vec2d point(sample.x, sample.y);
  if (!is_inside(point, grid)) return false;
  const int tile = grid.tile_at(point.x, point.y);
  const std::optional<Refinement> asked = std::exchange(wanted_, std::nullopt);
  const Refinement* wanted = asked && asked->point == point ? &*asked : nullptr;
  const bool was_planar = delaunay_.is_planar();
  MeshCorner corner{sample.ray.color, sample.ray.primitive, feature_of(kUnknownError, sample.ray.rays),
                    region_.owns_tile(tile)};
  if (was_planar) {
    const Index at = find(point, tile, wanted);
    if (at == Delaunay::kNowhere) return false;
    if (terms_.learned && delaunay_.triangles()[at].is_finite()) {
      const float error = error_found(at, sample);
      corner.feature = feature_of(error, sample.ray.rays);
      if (wanted != nullptr && at == wanted->triangle_) learn(at, error, sample.ray.rays);
    }
    delaunay_.insert(point, at);
  } else if (!delaunay_.insert_before_planar(point)) {
    return false;
  }
  samples_.push_back(sample);
  corners_.push_back(corner);
  if (was_planar) {
    for (const Index t : delaunay_.new_triangles()) retire(delaunay_.record(t));
    if (enqueues) enqueue_new();
  } else if (delaunay_.is_planar()) {
    enqueue_all_again();
  }
  return true;
}

// Returns a triangle that the point destroys; kNowhere where a sample is already. `wanted`: the point's own
// refinement, or null.
SampleMesh::Index SampleMesh::find(const Vec2d& point, int tile, const Refinement* wanted) {
  Index& in_tile = latest_in_tile_[static_cast<std::size_t>(tile)];
  Index& in_cell = latest_in_cell_[cell_of(point)];
  Index at = wanted != nullptr ? wanted->triangle_ : Delaunay::kNowhere;
  if (at == Delaunay::kNowhere || !delaunay_.surely_holds(at, point)) {
    const Index from = in_cell != Delaunay::kNowhere ? in_cell : in_tile;
    at = delaunay_.locate(point, from == Delaunay::kNowhere ? 0 : from);
    if (at == Delaunay::kNowhere) return at;
  }
  in_tile = in_cell = at;
  return at;
}

std::size_t SampleMesh::cell_of(const Vec2d& point) const {
  const auto column = static_cast<std::size_t>(point.x) / kCellPixels;
  const auto row = static_cast<std::size_t>(point.y) / kCellPixels;
  const auto columns = static_cast<std::size_t>(region_.grid().width) / kCellPixels + 1;
  return row * columns + column;
}

// What the picture shows, and what its errors teach.

// Returns the squared error of the picture at a sample: a mean over the channels, on the display scale.
float SampleMesh::error_found(Index triangle, const Sample& sample) const {
  const float4 difference = on_display(channels_before_more(&sample.ray.color)) -
                            on_display(color_shown(triangle, sample.ray.primitive));
  const float4 squared = difference * difference;
  return (squared[0] + squared[1] + squared[2]) * (1.0F / 3);
}

void SampleMesh::learn(Index triangle, float squared_error, std::uint32_t rays) {
  const TriangleRecord& record = delaunay_.record(triangle);
  learned_.learn(record.bin, record.weight, squared_error, static_cast<float>(area_of(triangle)), rays);
}

SampleMesh::Guess SampleMesh::guess(const Refinement& at, std::uint32_t primitive) const {
  const float4 shown = color_shown(at.triangle_, primitive);
  return {{shown[0], shown[1], shown[2]}, area_of(at.triangle_)};
}

// Returns the mean colour of all corners. Where pictures show edges and some corner is on the primitive, the
// corners on it have kEdgeShare.
float4 SampleMesh::color_shown(Index triangle, std::uint32_t primitive) const {
  float4 all{}, on_primitive{};
  int count = 0;
  for (const Index corner : delaunay_.triangles()[triangle].corners) {
    const float4 color = corners_[corner].channels();
    const std::int32_t is_on = corners_[corner].primitive == primitive ? 1 : 0;
    all += color;
    on_primitive += std::bit_cast<float4>(std::bit_cast<int4>(color) & -is_on);
    count += is_on;
  }
  constexpr std::array<float, 4> kOneOver = {0, 1, 1.0F / 2, 1.0F / 3};
  const float share = terms_.edges && count > 0 ? kEdgeShare : 0;
  const auto i = static_cast<std::size_t>(count);
  return all * ((1 - share) * kOneOver[3]) + on_primitive * (share * kOneOver[i]);
}

// The queue and the statistics of its triangles.

void SampleMesh::enqueue_new() {
  fan_weights_.compute(delaunay_, corners_, terms_);
  const std::span<const Index> triangles = delaunay_.new_triangles();
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    if (!delaunay_.triangles()[triangles[k]].is_finite()) continue;
    enqueue(triangles[k], fan_weights_.weight(k), fan_weights_.bin(k));
    note_at_border(triangles[k]);
  }
}

void SampleMesh::enqueue(Index triangle) {
  const Delaunay::Triangle& t = delaunay_.triangles()[triangle];
  const auto& [a, b, c] = t.corners;
  const MeshCorner &p = corners_[a], &q = corners_[b], &r = corners_[c];
  const float variance = display_variance(p.color, q.color, r.color);
  const auto bin =
      bin_of(static_cast<std::int32_t>(p.primitive), static_cast<std::int32_t>(q.primitive),
             static_cast<std::int32_t>(r.primitive), variance, p.feature + q.feature + r.feature);
  enqueue(triangle, refinement_weight(t.circle.size_squared, variance, terms_), static_cast<Bin>(bin));
}

// A triangle that is refined elsewhere is only stamped: its rank counts its weight.
void SampleMesh::enqueue(Index triangle, float weight, Bin bin) {
  const Vec2d point = refinement_point(triangle);
  TriangleRecord& record = delaunay_.record(triangle);
  record.stamp = next_stamp_++;
  record.tile = region_.grid().tile_at(point.x, point.y);
  if (region_.owns_tile(record.tile)) {
    record.weight = weight, record.bin = bin;
    count(record, 1);
    if (terms_.learned) {
      const float in_pixels = delaunay_.triangles()[triangle].circle.size_squared / kPixelSizeSquared;
      weight *= learned_.correction(bin) * (in_pixels < 1 ? std::sqrt(in_pixels) : 1);
    }
    if (weight > 0) queue_.push(weight, {triangle, record.stamp});
  }
}

// Removes a destroyed triangle from the statistics. Its entry in the queue is skipped when it is popped.
void SampleMesh::retire(TriangleRecord& record) {
  if (record.stamp == 0) return;
  if (region_.owns_tile(record.tile)) count(record, -1);
  record.stamp = 0;
}

void SampleMesh::count(const TriangleRecord& record, int sign) {
  TileWeights& weights = tile_weights_[static_cast<std::size_t>(record.tile)];
  weights.count += sign;
  // The last triangle takes the rounding of the running sum with it.
  weights.total_weight = weights.count == 0 ? 0 : weights.total_weight + sign * record.weight;
  all_weights_.count += sign;
  all_weights_.total_weight += sign * record.weight;
}

double SampleMesh::mean_weight() const {
  TileWeights all;
  for (const TileWeights& tile : tile_weights_) {
    all.count += tile.count;
    all.total_weight += tile.total_weight;
  }
  return all.count > 0 ? all.total_weight / static_cast<double>(all.count) : 0;
}

bool SampleMesh::is_refined_to(double weight) const {
  constexpr double kRounding = 1e-6;  // far above that of the running sum
  const double about =
      all_weights_.total_weight / static_cast<double>(std::max<std::int64_t>(all_weights_.count, 1));
  return about <= weight * (1 + kRounding) && mean_weight() <= weight;
}

void SampleMesh::enqueue_all_again() {
  queue_.clear();
  wanted_.reset();
  tile_weights_.assign(tile_weights_.size(), {});
  all_weights_ = {};
  const auto& triangles = delaunay_.triangles();
  for (Index t = 0; t < triangles.size(); ++t) delaunay_.record(t) = {};
  for (Index t = 0; t < triangles.size(); ++t) {
    if (triangles[t].is_finite()) enqueue(t);
  }
}

// Where the next sample is wanted.

std::optional<Refinement> SampleMesh::next_point() {
  constexpr std::size_t kAhead = 4;
  while (const std::optional<StampedTriangle> popped = queue_.pop()) {
    if (const StampedTriangle* soon = queue_.ahead(kAhead))
      __builtin_prefetch(&delaunay_.triangles()[soon->triangle]);
    if (!exists(*popped)) continue;
    const Vec2d point = refinement_point(popped->triangle);
    // A point rounded onto a sample: the triangle is as fine as coordinates allow.
    if (!delaunay_.surely_holds(popped->triangle, point) &&
        delaunay_.locate(point, popped->triangle) == Delaunay::kNowhere)
      continue;
    wanted_ = Refinement(point, popped->triangle);
    return wanted_;
  }
  return std::nullopt;
}

// The heaviest weight falls with the samples to the power of about -1.35. A triangle that is still heavier
// than a power of -1.2 allows is certain to be refined. No new floor before the old one is reached: only then
// does the queue's level tell how far refinement is.
void SampleMesh::expect_growth(double factor) {
  constexpr double kSurePower = 1.2;
  if (queue_.is_above_floor()) return;
  queue_.set_floor(queue_.level() / static_cast<float>(std::pow(std::max(1.0, factor), kSurePower)));
}

Vec2d SampleMesh::refinement_point(Index triangle) const {
  const Vec2d center = delaunay_.circumcenter(triangle);
  return is_inside(center, region_.grid()) ? center
                                           : exit_towards(center, points_of(triangle), region_.grid());
}

SampleMesh::Points SampleMesh::points_of(Index triangle) const {
  const auto& [a, b, c] = delaunay_.triangles()[triangle].corners;
  const Vec2d* points = delaunay_.points().data();
  return {points[a], points[b], points[c]};
}

double SampleMesh::area_of(Index triangle) const {
  const Points corners = points_of(triangle);
  const Vec2d ab = corners[1] - corners[0], ac = corners[2] - corners[0];
  return 0.5 * (ab.x * ac.y - ab.y * ac.x);
}

// Triangles at the border, for the exchange between ranks.

void SampleMesh::note_at_border(Index triangle) {
  if (region_.is_whole()) return;
  const auto& corners = delaunay_.triangles()[triangle].corners;
  const std::array<bool, 3> own = {corners_[corners[0]].own, corners_[corners[1]].own,
                                   corners_[corners[2]].own};
  if (!own[0] && !own[1] && !own[2] && !notes_foreign_) return;
  const Circle circle{delaunay_.circumcenter(triangle),
                      delaunay_.triangles()[triangle].circle.radius_squared()};
  if (region_.surely_holds(circle)) return;
  new_at_border_.push_back({{triangle, delaunay_.record(triangle).stamp}, {circle, corners, own}});
}

void SampleMesh::take_new_at_border(std::vector<BorderTriangle>& triangles) {
  triangles.clear();
  for (const StampedBorderTriangle& b : new_at_border_) {
    if (exists(b.stamped)) triangles.push_back(b.triangle);
  }
  new_at_border_.clear();
}

std::vector<std::array<std::uint32_t, 3>> triangles(const SampleMesh& mesh) {
  std::vector<std::array<std::uint32_t, 3>> result;
  for (const Delaunay::Triangle& t : mesh.triangulation().triangles()) {
    if (t.is_finite()) result.push_back(t.corners);
  }
  return result;
}

}  // namespace pprt
