#include "scene/polygons/vertex_tree.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "scene/polygons/ear_ranking.h"
#include "scene/polygons/turn.h"

namespace pprt::vertex_tree_test {

TEST_CASE("the tree finds vertices in a triangle as a search through all of them does") {
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> u(-1, 1);
  std::vector<Vec2d> points;
  for (int i = 0; i < 2000; ++i) points.emplace_back(u(engine), i % 3 == 0 ? 0.25 : 0.01 * u(engine));
  std::vector<std::uint32_t> members;
  for (std::uint32_t i = 0; i < points.size(); i += 2) members.push_back(i);
  VertexTree tree(points, members);
  const auto any_of_all = [&](const Vec2d& a, const Vec2d& b, const Vec2d& c) {
    return std::any_of(members.begin(), members.end(), [&](std::uint32_t i) {
      const Vec2d& p = points[i];
      return p != a && p != b && p != c && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
    });
  };
  int found = 0, tried = 0;
  while (!members.empty()) {
    for (int i = 0; i < 20; ++i) {
      const Vec2d& a = points[engine() % points.size()];
      const Vec2d b = a + Vec2d(u(engine), 0.1 * u(engine)) * 0.1, c = a + Vec2d(u(engine), u(engine)) * 0.05;
      if (!(turn(a, b, c) > 0)) continue;
      const bool expected = any_of_all(a, b, c);
      CHECK(tree.any_within(a, b, c) == expected);
      found += expected;
      ++tried;
    }
    const std::size_t gone = engine() % members.size();
    tree.remove(members[gone]);
    tree.remove(members[gone]);  // a second time is nothing
    members.erase(members.begin() + static_cast<std::ptrdiff_t>(gone));
  }
  CHECK(found > tried / 10);
  CHECK(found < tried / 10 * 9);
}

TEST_CASE("the best ear is the first of the largest quality from a vertex on") {
  std::mt19937 engine(5);
  for (const std::size_t n : {1u, 2u, 5u, 8u, 13u}) {
    EarRanking ranking(n, -1);
    CHECK(ranking.best(0) == 0);
    std::vector<double> quality(n, -1);
    for (int i = 0; i < 300; ++i) {
      const auto vertex = static_cast<std::uint32_t>(engine() % n),
                 start = static_cast<std::uint32_t>(engine() % n);
      ranking.set(vertex, quality[vertex] = static_cast<double>(engine() % 4));
      std::uint32_t best = start;
      for (std::uint32_t k = 1; k < n; ++k) {
        const auto at = static_cast<std::uint32_t>((start + k) % n);
        if (quality[at] > quality[best]) best = at;
      }
      CHECK(ranking.best(start) == best);
      CHECK(ranking[vertex] == quality[vertex]);
    }
  }
}

}  // namespace pprt::vertex_tree_test
