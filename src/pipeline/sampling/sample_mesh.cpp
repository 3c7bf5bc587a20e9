#include "pipeline/sampling/sample_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "pipeline/sampling/sample_mesh_impl.h"

namespace pprt {
namespace {

constexpr float kUnknownError = 1.0F / 32;  // where no triangle tells what the picture would have shown

// Channels held to the display scale.
float4 on_display(const float4& channels) {
  return min(max(channels, float4{}), float4{1, 1, 1, 0});
}

bool is_inside(const Vec2d& point, const TileGrid& image) {
  return point.x >= 0 && point.x <= image.width && point.y >= 0 && point.y <= image.height;
}

// Where the way to a circumcentre outside the image leaves it. From the centroid, which is inside both image
// and circumcircle: every point of the way is inside the circle too, so a sample there does destroy the
// triangle.
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

SampleMesh::SampleMesh(const Region& region, const WeightTerms& terms)
    : impl_(std::make_unique<Impl>(region, terms)) {}
SampleMesh::SampleMesh(SampleMesh&&) noexcept = default;
SampleMesh& SampleMesh::operator=(SampleMesh&&) noexcept = default;
SampleMesh::~SampleMesh() = default;

void SampleMesh::clear() {
  impl_->clear();
}
void SampleMesh::restart() {
  impl_->restart();
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
void SampleMesh::begin_many() {
  impl_->begin_many();
}
void SampleMesh::end_many() {
  impl_->end_many();
}
std::optional<Vec2d> SampleMesh::next_point() {
  return impl_->next_point();
}
void SampleMesh::expect_growth(double factor) {
  impl_->expect_growth(factor);
}
SampleMesh::Guess SampleMesh::guess(std::uint32_t primitive) const {
  return impl_->guess(primitive);
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
  restart();
  learned_ = {};
}

void SampleMesh::Impl::restart() {
  const auto tiles = static_cast<std::size_t>(region_.grid().tile_count());
  delaunay_.clear();
  samples_.clear();
  corners_.clear();
  new_at_border_.clear();
  queue_.clear();
  queue_.set_floor(std::numeric_limits<float>::infinity());
  tile_weights_.assign(tiles, {});
  latest_in_tile_.assign(tiles, Delaunay::kNowhere);
  latest_in_cell_.assign(cell_of({0.0 + region_.grid().width, 0.0 + region_.grid().height}) + 1,
                         Delaunay::kNowhere);
  next_stamp_ = 1;
  notes_foreign_ = inserts_many_ = false;
  wanted_.reset();
}

void SampleMesh::Impl::set_region(const Region& region) {
  region_ = region;
  for (std::size_t i = 0; i < samples_.size(); ++i)
    corners_[i].own = region_.owns_point(samples_[i].x, samples_[i].y);
  rescan();
}

bool SampleMesh::Impl::insert(const Sample& sample) {
  const TileGrid& grid = region_.grid();
  const Vec2d point(sample.x, sample.y);
  if (!is_inside(point, grid)) return false;
  const int tile = grid.tile_at(point.x, point.y);
  const bool is_wanted = std::exchange(wanted_, std::nullopt) == point;
  const bool was_planar = delaunay_.is_planar();
  Corner corner{sample.ray.color, sample.ray.primitive, trait_of(kUnknownError, sample.ray.rays),
                region_.owns_tile(tile)};
  if (was_planar) {
    const Index at = find(point, tile, is_wanted);
    if (at == Delaunay::kNowhere) return false;
    if (terms_.learned && delaunay_.triangles()[at].is_finite()) {
      const float error = error_found(at, sample);
      corner.trait = trait_of(error, sample.ray.rays);
      if (is_wanted && at == refined_) learn(error, sample.ray.rays);
    }
    delaunay_.insert(point, at);
  } else if (!delaunay_.insert_before_planar(point)) {
    return false;
  }
  samples_.push_back(sample);
  corners_.push_back(corner);
  if (was_planar) {
    admit();
  } else if (delaunay_.is_planar()) {
    rescan();
  }
  return true;
}

SampleMesh::Impl::Index SampleMesh::Impl::find(const Vec2d& point, int tile, bool is_wanted) {
  Index& in_tile = latest_in_tile_[static_cast<std::size_t>(tile)];
  Index& in_cell = latest_in_cell_[cell_of(point)];
  Index at = refined_;
  if (!is_wanted || !delaunay_.surely_holds(refined_, point)) {
    const Index from = in_cell != Delaunay::kNowhere ? in_cell : in_tile;
    at = delaunay_.locate(point, from == Delaunay::kNowhere ? 0 : from);
    if (at == Delaunay::kNowhere) return at;
  }
  in_tile = in_cell = at;
  return at;
}

float SampleMesh::Impl::error_found(Index triangle, const Sample& sample) const {
  const float4 difference = on_display(channels_before_more(&sample.ray.color)) -
                            on_display(shown_of(triangle, sample.ray.primitive));
  const float4 squared = difference * difference;
  return (squared[0] + squared[1] + squared[2]) * (1.0F / 3);
}

void SampleMesh::Impl::learn(float squared_error, std::uint32_t rays) {
  const Tally& tally = delaunay_.note(refined_);
  learned_.learn(tally.kind, tally.weight, squared_error, static_cast<float>(area(refined_)), rays);
}

void SampleMesh::Impl::admit() {
  const std::span<const Index> triangles = delaunay_.new_triangles();
  for (const Index t : triangles) forget(delaunay_.note(t));
  if (inserts_many_) return;
  weigh_new();
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    if (!delaunay_.triangles()[triangles[k]].is_finite()) continue;
    adopt(triangles[k], weights_[k], kinds_[k]);
    note_at_border(triangles[k]);
  }
}

// Four at once. Their corners stand around the one that they share, so differences of colour serve two each.
void SampleMesh::Impl::weigh_new() {
  const std::span<const Index> around = delaunay_.around_new(), triangles = delaunay_.new_triangles();
  const std::size_t count = around.size(), padded = (count + kLanes - 1) / kLanes * kLanes;
  const auto shown = [&](Index corner) { return on_display(corners_[corner].channels()); };
  const auto apex = static_cast<Index>(corners_.size() - 1);
  const float4 center = shown(apex);
  shown_.resize(padded + kLanes), weights_.resize(padded), kinds_.resize(padded);
  primitives_.resize(padded + kLanes), traits_.resize(padded + kLanes);
  for (std::size_t k = 0; k < count; ++k) {
    const Index corner = around[k] == Delaunay::kInfinite ? apex : around[k];
    shown_[k] = shown(corner);
    primitives_[k] = static_cast<std::int32_t>(corners_[corner].primitive);
    traits_[k] = corners_[corner].trait;
  }
  shown_[count] = shown_[0], primitives_[count] = primitives_[0], traits_[count] = traits_[0];
  const int4 primitive = int4{} + static_cast<std::int32_t>(corners_[apex].primitive);
  const auto squared_differences = [&](std::size_t k, auto&& other) {
    const auto square = [](const float4& v) { return v * v; };
    float4 a = square(shown_[k] - other(k)), b = square(shown_[k + 1] - other(k + 1)),
           c = square(shown_[k + 2] - other(k + 2)), d = square(shown_[k + 3] - other(k + 3));
    transpose(a, b, c, d);
    return a + b + c;
  };
  const auto to_center = [&](std::size_t k) {
    return squared_differences(k, [&](std::size_t) { return center; });
  };
  float4 next = to_center(0);
  for (std::size_t k = 0; k < count; k += kLanes) {
    const float4 here = next;
    next = to_center(k + kLanes);
    const float4 after = __builtin_shufflevector(here, next, 1, 2, 3, 4);
    const float4 between = squared_differences(k, [&](std::size_t i) { return shown_[i + 1]; });
    const float4 variance = (here + after + between) * (1.0F / 27);
    float4 size_squared{};
    for (std::size_t i = 0; i < kLanes && k + i < count; ++i)
      size_squared[i] = delaunay_.triangles()[triangles[k + i]].circle.size_squared;
    store(refinement_weight(size_squared, variance, terms_), &weights_[k]);
    const int4 traits = load<int4>(&traits_[k]) + load<int4>(&traits_[k + 1]);
    store(triangle_kind(primitive, load<int4>(&primitives_[k]), load<int4>(&primitives_[k + 1]), variance,
                        traits + corners_[apex].trait),
          &kinds_[k]);
  }
}

void SampleMesh::Impl::end_many() {
  inserts_many_ = false;
  for (Index t = 0; t < delaunay_.triangles().size(); ++t) {
    if (delaunay_.note(t).stamp != 0 || !delaunay_.triangles()[t].is_finite()) continue;
    adopt(t);
    note_at_border(t);
  }
}

void SampleMesh::Impl::note_at_border(Index triangle) {
  if (region_.is_whole()) return;
  const auto& corners = delaunay_.triangles()[triangle].corners;
  const std::array<bool, 3> own = {corners_[corners[0]].own, corners_[corners[1]].own,
                                   corners_[corners[2]].own};
  if (!own[0] && !own[1] && !own[2] && !notes_foreign_) return;
  const Circle circle{delaunay_.circumcenter(triangle),
                      delaunay_.triangles()[triangle].circle.radius_squared()};
  if (region_.surely_holds(circle)) return;
  new_at_border_.push_back({{triangle, delaunay_.note(triangle).stamp}, {circle, corners, own}});
}

std::optional<Vec2d> SampleMesh::Impl::next_point() {
  constexpr std::size_t kAhead = 4;
  while (const std::optional<QueueEntry> entry = queue_.pop()) {
    if (const QueueEntry* soon = queue_.ahead(kAhead))
      __builtin_prefetch(&delaunay_.triangles()[soon->triangle]);
    if (!lives(*entry)) continue;  // destroyed since it was queued
    const Vec2d point = refinement_point(entry->triangle);
    // Rounded onto a sample it is as fine as coordinates allow.
    if (!delaunay_.surely_holds(entry->triangle, point) &&
        delaunay_.locate(point, entry->triangle) == Delaunay::kNowhere)
      continue;
    refined_ = entry->triangle;
    wanted_ = point;
    return point;
  }
  return std::nullopt;
}

void SampleMesh::Impl::take_new_at_border(std::vector<BorderTriangle>& triangles) {
  triangles.clear();
  for (const BorderEntry& b : new_at_border_) {
    if (lives(b.entry)) triangles.push_back(b.triangle);
  }
  new_at_border_.clear();
}

// The heaviest weight falls with the samples' power of about 1.35; what a power of 1.2 comes down to is
// surely refined. No new floor before the old one is reached: only there does the queue tell how far
// refinement is.
void SampleMesh::Impl::expect_growth(double factor) {
  constexpr double kSurePower = 1.2;
  if (queue_.is_above_floor()) return;
  queue_.set_floor(queue_.level() / static_cast<float>(std::pow(std::max(1.0, factor), kSurePower)));
}

SampleMesh::Guess SampleMesh::Impl::guess(std::uint32_t primitive) const {
  const float4 shown = shown_of(refined_, primitive);
  return {{shown[0], shown[1], shown[2]}, area(refined_)};
}

float4 SampleMesh::Impl::shown_of(Index triangle, std::uint32_t primitive) const {
  float4 all{}, beside{};
  int count = 0;
  for (const Index corner : delaunay_.triangles()[triangle].corners) {
    const float4 color = corners_[corner].channels();
    const std::int32_t is_beside = corners_[corner].primitive == primitive ? 1 : 0;
    all += color;
    beside += std::bit_cast<float4>(std::bit_cast<int4>(color) & -is_beside);
    count += is_beside;
  }
  constexpr std::array<float, 4> kOneOver = {0, 1, 1.0F / 2, 1.0F / 3};
  const float share = terms_.edges && count > 0 ? kEdgeShare : 0;
  const auto i = static_cast<std::size_t>(count);
  return all * ((1 - share) * kOneOver[3]) + beside * (share * kOneOver[i]);
}

double SampleMesh::Impl::area(Index triangle) const {
  const Points corners = points(triangle);
  const Vec2d ab = corners[1] - corners[0], ac = corners[2] - corners[0];
  return 0.5 * (ab.x * ac.y - ab.y * ac.x);
}

Vec2d SampleMesh::Impl::refinement_point(Index triangle) const {
  const Vec2d center = delaunay_.circumcenter(triangle);
  return is_inside(center, region_.grid()) ? center : exit_towards(center, points(triangle), region_.grid());
}

SampleMesh::Impl::Points SampleMesh::Impl::points(Index triangle) const {
  const auto& [a, b, c] = delaunay_.triangles()[triangle].corners;
  const Vec2d* points = delaunay_.points().data();
  return {points[a], points[b], points[c]};
}

void SampleMesh::Impl::adopt(Index triangle) {
  const Delaunay::Triangle& t = delaunay_.triangles()[triangle];
  const auto& [a, b, c] = t.corners;
  const Corner &p = corners_[a], &q = corners_[b], &r = corners_[c];
  const float variance = display_variance(p.color, q.color, r.color);
  const auto kind =
      triangle_kind(static_cast<std::int32_t>(p.primitive), static_cast<std::int32_t>(q.primitive),
                    static_cast<std::int32_t>(r.primitive), variance, p.trait + q.trait + r.trait);
  adopt(triangle, refinement_weight(t.circle.size_squared, variance, terms_),
        static_cast<TriangleKind>(kind));
}

void SampleMesh::Impl::adopt(Index triangle, float weight, TriangleKind kind) {
  const Vec2d point = refinement_point(triangle);
  Tally& tally = delaunay_.note(triangle);
  tally.stamp = next_stamp_++;
  tally.tile = region_.grid().tile_at(point.x, point.y);
  // What is refined elsewhere is weighed elsewhere.
  if (region_.owns_tile(tally.tile)) {
    tally.weight = weight, tally.kind = kind;
    count(tally, 1);
    if (terms_.learned) {
      const float in_pixels = delaunay_.triangles()[triangle].circle.size_squared / kPixelSizeSquared;
      weight *= learned_.correction(kind) * (in_pixels < 1 ? std::sqrt(in_pixels) : 1);
    }
    if (weight > 0) queue_.push(weight, {triangle, tally.stamp});
  }
}

void SampleMesh::Impl::forget(Tally& tally) {
  if (tally.stamp == 0) return;
  if (region_.owns_tile(tally.tile)) count(tally, -1);
  tally.stamp = 0;
}

void SampleMesh::Impl::count(const Tally& tally, int sign) {
  TileWeights& weights = tile_weights_[static_cast<std::size_t>(tally.tile)];
  weights.triangles += sign;
  // The last triangle takes the rounding of the running sum with it.
  weights.total_weight = weights.triangles == 0 ? 0 : weights.total_weight + sign * tally.weight;
}

double SampleMesh::Impl::refinement() const {
  TileWeights all;
  for (const TileWeights& tile : tile_weights_) {
    all.triangles += tile.triangles;
    all.total_weight += tile.total_weight;
  }
  return all.triangles > 0 ? all.total_weight / static_cast<double>(all.triangles) : 0;
}

void SampleMesh::Impl::rescan() {
  queue_.clear();
  wanted_.reset();
  tile_weights_.assign(tile_weights_.size(), {});
  const auto& triangles = delaunay_.triangles();
  for (Index t = 0; t < triangles.size(); ++t) delaunay_.note(t) = {};
  for (Index t = 0; t < triangles.size(); ++t) {
    if (triangles[t].is_finite()) adopt(t);
  }
}

std::vector<std::array<std::uint32_t, 3>> triangles(const SampleMesh& mesh) {
  std::vector<std::array<std::uint32_t, 3>> result;
  for (const Delaunay::Triangle& t : mesh.impl().delaunay().triangles()) {
    if (t.is_finite()) result.push_back(t.corners);
  }
  return result;
}

}  // namespace pprt
