// The two sides of the slits in a surface.
#include <palpate/cut/detail/slit_sides.hpp>

#include "catch.hpp"

using namespace palpate;

namespace {

/// A strip of squares, two triangles each, of `rows` x 7 vertices; between columns 2 and 3 it may be slit: then column
/// 2 has copies, which belong to the right part.
struct SlitStrip {
  std::vector<Triangle> triangles;
  std::vector<NodeId> origin;
  std::vector<int> left, right;
};
SlitStrip slit_strip(int rows, bool slit) {
  SlitStrip s;
  const int columns = 7;
  for (int v = 0; v < rows * columns; ++v) s.origin.push_back(v);
  for (int r = 0; r < rows; ++r) {
    s.left.push_back(r * columns + 2);
    s.right.push_back(r * columns + 2);
    if (!slit) continue;
    s.right.back() = static_cast<int>(s.origin.size());
    s.origin.push_back(s.origin[static_cast<std::size_t>(s.left.back())]);
    if (r % 2 == 1) std::swap(s.left.back(), s.right.back());  // either part may keep the number
  }
  const auto at = [&](int r, int c, bool of_right) {
    if (c != 2) return r * columns + c;
    return (of_right ? s.right : s.left)[static_cast<std::size_t>(r)];
  };
  for (int r = 0; r + 1 < rows; ++r)
    for (int c = 0; c + 1 < columns; ++c) {
      s.triangles.push_back({at(r, c, c >= 2), at(r, c + 1, c >= 2), at(r + 1, c + 1, c >= 2)});
      s.triangles.push_back({at(r, c, c >= 2), at(r + 1, c + 1, c >= 2), at(r + 1, c, c >= 2)});
    }
  return s;
}

}  // namespace

TEST_CASE("the lips of a slit are on two sides, whichever part keeps the vertices", "[cut][moving][sides]") {
  const SlitStrip s = slit_strip(5, true);
  const std::vector<double> side = detail::slit_sides(s.triangles, s.origin);
  REQUIRE(side.size() == s.origin.size());
  const double left = side[static_cast<std::size_t>(s.left[0])];
  CHECK(std::abs(left) == 1.0);
  for (std::size_t r = 0; r < 5; ++r) {
    CHECK(side[static_cast<std::size_t>(s.left[r])] == left);
    CHECK(side[static_cast<std::size_t>(s.right[r])] == -left);
    const std::size_t row = 7 * r;
    CHECK(side[row + 1] * left > 0.0);
    CHECK(std::abs(side[row + 1]) < 1.0);
    CHECK(side[row + 3] * left < 0.0);
    CHECK(std::abs(side[row + 4]) < std::abs(side[row + 3]));
    CHECK(side[row + 6] == 0.0);  // far away
  }
}

TEST_CASE("a surface without slits has no sides", "[cut][moving][sides]") {
  const SlitStrip s = slit_strip(3, false);
  for (const double x : detail::slit_sides(s.triangles, s.origin)) CHECK(x == 0.0);
}
