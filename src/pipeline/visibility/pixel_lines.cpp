#include "pipeline/visibility/pixel_lines.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <limits>

#include "base/simd.h"
#include "pipeline/silhouettes/shape_nearness.h"

namespace pprt {

Depths depths_of(const ShapeInPixel& shape) {
  if (shape.quadric != nullptr) return {0, std::numeric_limits<float>::infinity()};
  const NearLinear& n = shape.facet->nearness;
  const float at_corner = value(n, shape.left, shape.top);
  return {at_corner + std::min(n.per_x, 0.0F) + std::min(n.per_y, 0.0F),
          at_corner + std::max(n.per_x, 0.0F) + std::max(n.per_y, 0.0F)};
}

namespace {

constexpr std::size_t kMostShapes = 64, kMostMet = 16;  // in the pixel's bounds, and on its lines
constexpr float kNoOverlap = 1e-4F;    // of a line: edges that two facets share may err by as much
constexpr float kNearEnd = 1.0F / 16;  // of a part of a line: what is seen at its very ends is rounding

// Eight lines across a pixel: their distances from its corner in sides of the pixel, as the places on them.
struct Lines {
  bool are_rows;  // along x, otherwise along y
  PerPoint at;
};

// In the middles of eighths of a pixel.
constexpr PerPoint kEighths = {0.0625F, 0.1875F, 0.3125F, 0.4375F, 0.5625F, 0.6875F, 0.8125F, 0.9375F};

// The part of each line in which a shape is seen; none where it does not end beyond its beginning.
struct Ends {
  PerPoint begin, end;
};

using Lanes = std::int32_t __attribute__((vector_size(kPoints * sizeof(std::int32_t))));

bool is_any(const Lanes& lanes) {
  using Halves = std::int64_t __attribute__((vector_size(sizeof(Lanes))));
  const auto h = std::bit_cast<Halves>(lanes);
  return ((h[0] | h[1]) | (h[2] | h[3])) != 0;
}

// A form's change along the lines and across them.
struct Slopes {
  float along, across;
};
template <class Form>
Slopes slopes(const Form& form, const Lines& lines) {
  return lines.are_rows ? Slopes{form.per_x, form.per_y} : Slopes{form.per_y, form.per_x};
}

Ends whole_lines() {
  return {PerPoint{}, PerPoint{} + 1};
}

// Keeps the part of each line where a form is not negative.
void cut(const NearLinear& form, float left, float top, const Lines& lines, Ends& ends) {
  const auto [along, across] = slopes(form, lines);
  const PerPoint at_begin = value(form, left, top) + across * lines.at;
  if (along == 0) {
    ends.end = at_begin < 0 ? ends.begin - 1 : ends.end;
    return;
  }
  const PerPoint crossed = at_begin * (-1 / along);
  if (along > 0) {
    ends.begin = max(ends.begin, crossed);
  } else {
    ends.end = min(ends.end, crossed);
  }
}

// Behind the eye a facet's nearness is negative.
Ends ends_of(const ProjectedFacet& f, float left, float top, const Lines& lines) {
  Ends ends = whole_lines();
  for (const NearLinear& edge : f.edges) cut(edge, left, top, lines, ends);
  cut(f.nearness, left, top, lines, ends);
  return ends;
}

// Within its outline. `are_bounded`: that is one part of each line.
Ends ends_of(const ProjectedQuadric& q, float left, float top, const Lines& lines, bool& are_bounded) {
  const NearQuadratic& d = q.discriminant;
  const float square = lines.are_rows ? d.per_xx : d.per_yy;
  const float square_across = lines.are_rows ? d.per_yy : d.per_xx;
  const float per_x = d.per_x + 2 * d.per_xx * left + d.per_xy * top;
  const float per_y = d.per_y + 2 * d.per_yy * top + d.per_xy * left;
  const PerPoint half = 0.5F * ((lines.are_rows ? per_x : per_y) + d.per_xy * lines.at);
  const PerPoint rest =
      value(d, left, top) + lines.at * ((lines.are_rows ? per_y : per_x) + square_across * lines.at);
  are_bounded = square < 0;
  const float per_square = 1 / square;
  const PerPoint inside = half * half - square * rest;
  const PerPoint root = square_root(inside > 0 ? inside : PerPoint{});
  Ends ends = whole_lines();
  ends.begin = max(ends.begin, (root - half) * per_square);
  ends.end = min(ends.end, (-root - half) * per_square);
  ends.end = inside > 0 ? ends.end : ends.begin - 1;
  return ends;
}

PerPoint nearness_on_lines(const ShapeInPixel& shape, const Lines& lines, const PerPoint& at) {
  const PerPoint x = shape.left + (lines.are_rows ? at : lines.at);
  const PerPoint y = shape.top + (lines.are_rows ? lines.at : at);
  return shape.quadric != nullptr ? nearness(*shape.quadric, x, y) : nearness(*shape.facet, x, y);
}

bool is_round(const ShapeInPixel& shape) {
  return shape.quadric != nullptr;
}
bool may_jump(const ShapeInPixel& shape) {
  return is_round(shape) && shape.quadric->has_ends;
}

// Finds where a shape is seen if no other hides it. False where it is seen in parts of what lies within its
// outline.
bool find_ends(const ShapeInPixel& shape, const Lines& lines, Ends& ends) {
  if (shape.quadric == nullptr) {
    ends = ends_of(*shape.facet, shape.left, shape.top, lines);
    return true;
  }
  bool are_bounded = false;
  ends = ends_of(*shape.quadric, shape.left, shape.top, lines, are_bounded);
  if (!are_bounded) return false;
  if (shape.quadric->front && !shape.quadric->has_ends) return true;
  const PerPoint length = ends.end - ends.begin;
  const auto met = length > 0;
  const auto seen_at = [&](float share) {
    return nearness_on_lines(shape, lines, ends.begin + share * length) > 0;
  };
  const auto seen = seen_at(kNearEnd), also = seen_at(0.5F), last = seen_at(1 - kNearEnd);
  if (is_any(((seen ^ also) | (also ^ last)) & met)) return false;
  ends.end = seen ? ends.end : ends.begin - 1;
  return true;
}

PerPoint length_of(const Ends& ends) {
  return max(ends.end - ends.begin, PerPoint{});
}

Ends both(const Ends& a, const Ends& b) {
  return {max(a.begin, b.begin), min(a.end, b.end)};
}

// The parts of a shape's lines in which others are nearer.
class HiddenParts {
 public:
  void clear() { count_ = owners_ = 0; }

  // Adds the parts that a shape hides. False where these are too many.
  bool add(std::uint32_t owner, const Ends& parts) {
    const auto end = owner_.begin() + static_cast<std::ptrdiff_t>(count_);
    const bool is_new = std::find(owner_.begin(), end, owner) == end;
    if (count_ == kMost || (is_new && owners_ == kMostOwners)) return false;
    owners_ += is_new ? 1 : 0;
    owner_[count_] = owner, parts_[count_++] = parts;
    return true;
  }

  // By inclusion and exclusion: what has one owner does not overlap.
  PerPoint length() const {
    PerPoint all{};
    for (std::size_t i = 0; i < count_; ++i) {
      all += length_of(parts_[i]);
      for (std::size_t k = 0; k < i; ++k) {
        if (owner_[k] == owner_[i]) continue;
        const Ends twice = both(parts_[i], parts_[k]);
        all -= length_of(twice);
        for (std::size_t l = 0; l < k; ++l)
          if (owner_[l] != owner_[k] && owner_[l] != owner_[i]) all += length_of(both(twice, parts_[l]));
      }
    }
    return all;
  }

 private:
  static constexpr std::size_t kMost = 8, kMostOwners = 3;
  std::array<Ends, kMost> parts_;
  std::array<std::uint32_t, kMost> owner_;
  std::size_t count_ = 0, owners_ = 0;
};

// Divides the parts in which two shapes lie before each other. What is nearer changes at one point of a line
// at most. That is where the difference in nearness, linear in facets, is 0. False if it changes twice, or
// where the front of a cone ends and its back may be seen: it jumps there.
bool hide(const ShapeInPixel& a, const ShapeInPixel& b, const Ends& overlap, const Lines& lines,
          Ends& hidden_of_a, Ends& hidden_of_b) {
  const PerPoint inset = kNearEnd * length_of(overlap);
  PerPoint first = overlap.begin + inset, last = overlap.end - inset;
  const auto lead_of_a = [&](const PerPoint& at) {
    return nearness_on_lines(a, lines, at) - nearness_on_lines(b, lines, at);
  };
  PerPoint lead = lead_of_a(first), lead_then = lead_of_a(last);
  const auto leads = lead > 0;
  const auto is_crossed = leads ^ (lead_then > 0);
  if (is_round(a) || is_round(b)) {
    const PerPoint middle = 0.5F * (first + last), lead_between = lead_of_a(middle);
    const auto is_met = length_of(overlap) > kNoOverlap, is_first_half = leads ^ (lead_between > 0);
    const auto is_wrong =
        may_jump(a) || may_jump(b) ? is_first_half | is_crossed : is_first_half & ~is_crossed;
    if (is_any(is_wrong & is_met)) return false;
    last = is_first_half ? middle : last, lead_then = is_first_half ? lead_between : lead_then;
    first = is_first_half ? first : middle, lead = is_first_half ? lead : lead_between;
  }
  const PerPoint change = is_crossed ? lead - lead_then : PerPoint{} + 1;
  const PerPoint crossed = is_crossed ? first + lead / change * (last - first) : overlap.end;
  // Up to `crossed` the one is nearer, after it the other.
  hidden_of_b = {leads ? overlap.begin : crossed, leads ? crossed : overlap.end};
  hidden_of_a = {leads ? crossed : overlap.begin, leads ? overlap.end : crossed};
  return true;
}

// A shape on eight lines.
struct OnLines {
  std::size_t shape;
  Ends ends;
  Depths depths;
  HiddenParts hidden;
};

// Whether all of a shape is behind another.
bool is_behind(const OnLines& one, const OnLines& other) {
  const auto sticks_out = (one.ends.begin < other.ends.begin) | (one.ends.end > other.ends.end);
  return other.depths.least > one.depths.most && !is_any(sticks_out & (one.ends.end > one.ends.begin));
}

// Adds to `seen` what is seen of each shape, the sum over eight lines.
bool add_seen(std::span<const ShapeInPixel> shapes, const Lines& lines, std::span<float> seen) {
  std::array<OnLines, kMostMet> met;  // those that meet a line
  std::size_t count = 0;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    OnLines& one = met[count];
    if (!find_ends(shapes[i], lines, one.ends)) return false;
    if (!is_any(one.ends.end > one.ends.begin)) continue;
    one.shape = i, one.depths = depths_of(shapes[i]);
    const auto end = met.begin() + static_cast<std::ptrdiff_t>(count);
    if (std::any_of(met.begin(), end, [&](const OnLines& other) { return is_behind(one, other); })) continue;
    one.hidden.clear();
    if (++count == kMostMet) return false;
  }
  for (std::size_t i = 1; i < count; ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      OnLines &one = met[i], &other = met[k];
      const ShapeInPixel &shape = shapes[one.shape], &before = shapes[other.shape];
      const Ends overlap = both(one.ends, other.ends);
      if (!is_any(length_of(overlap) > kNoOverlap)) continue;
      if (before.owner == shape.owner) return false;
      Ends hidden_of_one = overlap, hidden_of_other = overlap;
      const bool is_one_behind = other.depths.least > one.depths.most;
      const bool is_other_behind = one.depths.least > other.depths.most;
      if (!is_one_behind && !is_other_behind &&
          !hide(before, shape, overlap, lines, hidden_of_other, hidden_of_one))
        return false;
      if ((!is_other_behind && !one.hidden.add(before.owner, hidden_of_one)) ||
          (!is_one_behind && !other.hidden.add(shape.owner, hidden_of_other)))
        return false;
    }
  }
  for (std::size_t i = 0; i < count; ++i)
    seen[met[i].shape] += sum_of(max(length_of(met[i].ends) - met[i].hidden.length(), PerPoint{}));
  return true;
}

}  // namespace

PPRT_CLONED_FOR_WIDE_REGISTERS
bool shares_on_lines(std::span<const ShapeInPixel> shapes, bool are_rows, int count,
                     std::span<float> shares) {
  if (shapes.size() > kMostShapes) return false;
  std::array<float, kMostShapes> seen;
  std::fill_n(seen.begin(), shapes.size(), 0.0F);
  const int groups = count / kPoints;
  const float per_group = 1 / static_cast<float>(groups);
  for (int group = 0; group < groups; ++group) {
    const PerPoint at = per_group * (kEighths + static_cast<float>(group));
    if (!add_seen(shapes, {are_rows, at}, seen)) return false;
  }
  for (std::size_t i = 0; i < shapes.size(); ++i)
    shares[shapes[i].owner] += seen[i] / static_cast<float>(count);
  return true;
}

}  // namespace pprt
