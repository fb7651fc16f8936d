// The measured positions of the beads of the Truth Cube.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/io/decimal.hpp>
#include <palpate/io/file.hpp>

#include <Eigen/SVD>

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

namespace truth_cube {

using namespace palpate;

inline constexpr int per_side = 7;        ///< beads along an edge
inline constexpr double edge = 80e-3;     ///< of the cube [m]
inline constexpr double spacing = 10e-3;  ///< nominal, of the beads [m]
inline constexpr std::array strains{"5 %", "12.5 %", "18.25 %"};
inline constexpr std::array nominal_travel{0.05 * edge, 0.125 * edge, 0.1825 * edge};  ///< [m]

/// A bead in the frame of the cube: a corner at the origin, the platen at z = 0 moving along +z, the bonded base at
/// z = 80 mm.
struct Bead {
  std::array<int, 3> place{};           ///< 0 ... 6 along x, y, z
  Vector3 rest = Vector3::Zero();       ///< [m]
  std::array<Vector3, 3> displacement;  ///< in the three states [m]

  bool outer() const {
    return std::ranges::any_of(place, [](int i) { return i == 0 || i == per_side - 1; });
  }
};

/// Numbers of a line between commas; empty when a cell is not a number.
inline std::vector<double> numbers_of(std::string_view line) {
  std::vector<double> numbers;
  while (!line.empty()) {
    const std::size_t comma = std::min(line.find(','), line.size());
    double value = 0.0;
    if (io::parse_decimal(line.substr(0, comma), value) != std::errc{}) return {};
    numbers.push_back(value);
    line.remove_prefix(std::min(comma + 1, line.size()));
  }
  return numbers;
}

/// Transforms from the frame of the scanner to that of the cube, given by the best fit of a regular lattice to the
/// beads at rest.
inline void align(std::vector<Bead>& beads) {
  Vector3 centre = Vector3::Zero();
  for (const Bead& b : beads) centre += b.rest / static_cast<double>(beads.size());
  Matrix3 lattice = Matrix3::Zero();
  for (const Bead& b : beads)
    lattice += (b.rest - centre) * Vector3(b.place[0] - 3, b.place[1] - 3, b.place[2] - 3).transpose();
  const Eigen::JacobiSVD<Matrix3> svd(lattice, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Matrix3 to_cube = svd.matrixV() * svd.matrixU().transpose();
  for (Bead& b : beads) {
    b.rest = to_cube * (b.rest - centre) + Vector3::Constant(0.5 * edge);
    for (Vector3& u : b.displacement) u = to_cube * u;
  }
}

/// Reads uniaxial_positions.csv: i, j, k and four positions [mm] per bead. Throws bad_file unless there are 343 beads,
/// one per place. Beads are ordered by place, x fastest.
inline std::vector<Bead> read_beads(const std::string& path) {
  const std::string text = io::read_file(path);
  std::vector<Bead> beads(per_side * per_side * per_side);
  std::vector<int> rows_of(beads.size(), 0);
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    const std::vector<double> n = numbers_of(line);
    if (n.size() != 15) continue;  // titles
    Bead bead;
    // The z of the scanner decreases with k; k = 7 is next to the platen.
    bead.place = {int(n[0]) - 1, int(n[1]) - 1, per_side - int(n[2])};
    if (std::ranges::any_of(bead.place, [](int i) { return i < 0 || i >= per_side; }))
      raise(SetupErrorKind::bad_file, path + ": a bead outside 1 ... 7");
    const auto at = [&](std::size_t state) {
      return Vector3(1e-3 * Vector3(n[3 + 3 * state], n[4 + 3 * state], n[5 + 3 * state]));
    };
    bead.rest = at(0);
    for (std::size_t s = 0; s < 3; ++s) bead.displacement[s] = at(s + 1) - bead.rest;
    const auto index = static_cast<std::size_t>(bead.place[0] + per_side * (bead.place[1] + per_side * bead.place[2]));
    beads[index] = bead;
    ++rows_of[index];
  }
  if (std::ranges::any_of(rows_of, [](int times) { return times != 1; }))
    raise(SetupErrorKind::bad_file, path + ": not one row for each of the 343 beads",
          "It must be uniaxial_positions.csv of the Truth Cube");
  align(beads);
  return beads;
}

}  // namespace truth_cube
