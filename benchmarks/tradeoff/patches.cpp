#include "patches.hpp"

#include <palpate/core/setup_error.hpp>
#include <palpate/mesh/selection.hpp>
#include <palpate/mesh/where.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <utility>

namespace tradeoff {
namespace {

std::string group_names(const Mesh<Tet4>& mesh) {
  std::string names;
  for (const Group& g : mesh.groups.all()) names += " '" + g.name + "'";
  return names.empty() ? " none" : names;
}

bool is_name(const std::string& text, const Mesh<Tet4>& mesh) {
  return mesh.find_group(text) != nullptr || text == surface_group ||
         std::ranges::find(mesh.region_names, text) != mesh.region_names.end();
}

std::string without_spaces(const std::string& text) {
  std::string rest;
  std::ranges::copy_if(text, std::back_inserter(rest), [](char c) { return c != ' '; });
  return rest;
}

/// "z<0.01".
std::optional<Selection> half_space(const std::string& spaced) {
  const std::string text = without_spaces(spaced);
  if (text.size() < 3 || text[0] < 'x' || text[0] > 'z' || (text[1] != '<' && text[1] != '>')) return std::nullopt;
  const auto bound = number_of(text.substr(2));
  if (!bound) return std::nullopt;
  const int axis = text[0] - 'x';
  const Vector3 point = *bound * Vector3::Unit(axis);
  return text[1] == '<' ? where::below(point, Vector3::Unit(axis)) : where::above(point, Vector3::Unit(axis));
}

/// "box" or "sphere" and its numbers.
std::optional<Selection> solid(const std::string& text) {
  std::istringstream in(text);
  std::string word, part;
  in >> word;
  std::vector<double> v;
  while (in >> part) {
    const auto value = number_of(part);
    if (!value) return std::nullopt;
    v.push_back(*value);
  }
  if (word == "box" && v.size() == 6) return where::box({v[0], v[1], v[2]}, {v[3], v[4], v[5]});
  if (word == "sphere" && v.size() == 4) return where::sphere({v[0], v[1], v[2]}, v[3]);
  return std::nullopt;
}

double area(const Mesh<Tet4>& mesh, const BoundaryFace& f) {
  const Vector3 &a = mesh.position(f.nodes[0]), &b = mesh.position(f.nodes[1]), &c = mesh.position(f.nodes[2]);
  return 0.5 * (b - a).cross(c - a).norm();
}

Vector3 mean_position(const Mesh<Tet4>& mesh, const std::vector<NodeId>& nodes) {
  Vector3 sum = Vector3::Zero();
  for (const NodeId i : nodes) sum += mesh.position(i) / static_cast<double>(nodes.size());
  return sum;
}

/// Text of the side opposite to a part, along the axis in which that part is farthest from the middle.
std::string opposite(const Mesh<Tet4>& mesh, const std::vector<BoundaryFace>& boundary, const std::string& part) {
  const Vector3 off = mean_position(mesh, resolve_nodes(mesh, boundary, selection_of(part, mesh))) -
                      mean_position(mesh, nodes_of(boundary));
  int axis = 2;  // also when the part is on all sides
  for (const int other : {0, 1})
    if (std::abs(off[other]) > 1.01 * std::abs(off[axis])) axis = other;
  return outermost(mesh, boundary, axis, off[axis] > 0.0 ? -1 : 1);
}

}  // namespace

std::optional<double> number_of(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value)) return std::nullopt;
  return value;
}

Selection selection_of(const std::string& text, const Mesh<Tet4>& mesh) {
  if (is_name(text, mesh)) return text;
  if (auto selection = half_space(text)) return *selection;
  if (auto selection = solid(text)) return *selection;
  raise(SetupErrorKind::bad_argument, "'" + text + "' is no group of the mesh and no selection by position",
        "Give 'z<0.01', 'box x0 y0 z0 x1 y1 z1' or 'sphere x y z radius' in metres, in quotes, or a group; the mesh "
        "has" +
            group_names(mesh));
}

std::string outermost(const Mesh<Tet4>& mesh, const std::vector<BoundaryFace>& boundary, int axis, int side) {
  std::vector<std::pair<double, double>> faces;  // inmost coordinate towards `side`, area
  double total = 0.0, low = infinity, high = -infinity;
  for (const BoundaryFace& f : boundary) {
    double inmost = infinity;
    for (const NodeId i : f.nodes) {
      const double x = side * mesh.position(i)[axis];
      inmost = std::min(inmost, x);
      low = std::min(low, x);
      high = std::max(high, x);
    }
    faces.emplace_back(inmost, area(mesh, f));
    total += faces.back().second;
  }
  std::ranges::sort(faces, std::greater<>{});
  double covered = 0.0, bound = high;
  for (const auto& [inmost, part] : faces) {
    if (covered >= total / 12.0) break;
    covered += part;
    bound = inmost;
  }
  bound -= 1e-5 * (high - low);  // nodes of a flat side differ by rounding
  return std::string(1, static_cast<char>('x' + axis)) + (side > 0 ? '>' : '<') + number(side * bound);
}

Patches choose_patches(const Mesh<Tet4>& mesh, const std::vector<BoundaryFace>& boundary,
                       const std::string& constrained, const std::string& touched) {
  Patches p{constrained, touched, {}};
  const auto nodes = [&](const std::string& text) { return resolve_nodes(mesh, boundary, selection_of(text, mesh)); };
  const auto tell = [&](const char* option, const char* what, const std::string& text) {
    p.remark += std::string("no ") + option + " given: " + what + ", " + option + " \"" + text + "\" (" +
                std::to_string(nodes(text).size()) + " nodes)\n";
  };
  if (p.constrained.empty()) {
    p.constrained = touched.empty() ? outermost(mesh, boundary, 2, -1) : opposite(mesh, boundary, touched);
    tell("--fix", touched.empty() ? "fixed is the lowest part of the surface" : "fixed is the side opposite to --touch",
         p.constrained);
  }
  if (p.touched.empty()) {
    p.touched = opposite(mesh, boundary, p.constrained);
    tell("--touch", "touched is the side opposite to the fixed part", p.touched);
  }
  if (constrained.empty() || touched.empty()) {
    const auto fixed = nodes(p.constrained);
    std::vector<NodeId> free;
    for (const BoundaryFace& f : detail::resolve_faces(mesh, boundary, selection_of(p.touched, mesh)))
      std::ranges::copy_if(f.nodes, std::back_inserter(free),
                           [&](NodeId i) { return !std::ranges::binary_search(fixed, i); });
    if (free.empty())
      raise(SetupErrorKind::bad_argument,
            "all nodes of --touch \"" + p.touched + "\" are fixed by --fix \"" + p.constrained + '"',
            "Give --fix and --touch");
  }
  return p;
}

}  // namespace tradeoff
