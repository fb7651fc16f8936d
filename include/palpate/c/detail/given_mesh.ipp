// Definitions of given_mesh.hpp, and the functions of palpate_mesh.
#pragma once

#include <palpate/c/detail/given_mesh.hpp>
#include <palpate/c/detail/handles.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace c_interface {

PALPATE_INLINE Index GivenMesh::node_count() const noexcept {
  return static_cast<Index>(file ? file->positions.size() : plain.positions.size());
}

PALPATE_INLINE Vector3 GivenMesh::position(Index i) const noexcept {
  const auto at = static_cast<std::size_t>(i);
  return file ? Vector3(scale * file->positions[at]) : plain.positions[at];
}

PALPATE_INLINE void require_nodes_per_cell(const GivenMesh& given, int nodes) {
  if (given.nodes_per_cell != nodes)
    raise(SetupErrorKind::unsupported,
          "the cells of the mesh have " + std::to_string(given.nodes_per_cell) + " nodes, and the element has " +
              std::to_string(nodes),
          "Choose a policy whose element has as many nodes as the cells");
}

namespace {

/// Regions as MeshArrays names them.
void take_regions(std::span<const std::int32_t> regions, std::size_t cells, palpate::detail::PlainMesh& mesh) {
  std::int32_t last = 0;
  for (const std::int32_t region : regions) {
    if (region < 0 || static_cast<std::size_t>(region) > cells)
      raise(SetupErrorKind::index_out_of_range, "a cell is in region " + std::to_string(region),
            "Number regions from zero");
    last = std::max(last, region);
  }
  mesh.regions.assign(cells, 0);
  std::copy(regions.begin(), regions.end(), mesh.regions.begin());
  for (std::int32_t r = 0; r <= last; ++r)
    mesh.region_names.push_back(last == 0 ? "body" : "region " + std::to_string(r));
}

void require_existing(std::span<const std::int32_t> nodes, Index count) {
  std::vector<std::int64_t> missing;
  for (const std::int32_t node : nodes)
    if (node < 0 || node >= count) missing.push_back(node);
  if (missing.empty()) return;
  SetupProblem problem;
  problem.kind = SetupErrorKind::index_out_of_range;
  problem.what = std::to_string(missing.size()) + " nodes of a group do not exist";
  problem.hint = "The mesh has " + std::to_string(count) + " nodes, counted from zero";
  problem.set_ids(missing, SetupIds::nodes);
  problem.threshold = static_cast<double>(count);
  raise(std::move(problem));
}

void add_group(GivenMesh& mesh, const std::string& name, std::span<const std::int32_t> nodes) {
  if (name.empty()) refuse("the name of a group is empty");
  require_existing(nodes, mesh.node_count());
  Group& group = mesh.groups.get_or_add(name, 0);
  group.nodes.insert(group.nodes.end(), nodes.begin(), nodes.end());
}

}  // namespace

}}}  // namespace palpate::PALPATE_ABI::c_interface

extern "C" {

palpate_error palpate_mesh_read(const char* path, double scale, palpate_mesh** mesh) {
  using namespace palpate::c_interface;
  return guarded([&] {
    palpate_mesh*& out = target(mesh, "mesh");
    out = nullptr;
    if (!(scale >= 0.0) || !std::isfinite(scale)) refuse("the scale is not a positive number");
    auto made = std::make_unique<palpate_mesh>();
    made->given.file = palpate::io::read_file_mesh(text(path, "path"));
    made->given.scale = scale == 0.0 ? 1.0 : scale;
    out = made.release();
  });
}

palpate_error palpate_mesh_from_arrays(const double* positions, size_t node_count, const int32_t* cells,
                                       size_t cell_count, int32_t nodes_per_cell, const int32_t* regions,
                                       palpate_mesh** mesh) {
  using namespace palpate::c_interface;
  using palpate::SetupErrorKind;
  return guarded([&] {
    palpate_mesh*& out = target(mesh, "mesh");
    out = nullptr;
    if (nodes_per_cell != 4 && nodes_per_cell != 8 && nodes_per_cell != 10 && nodes_per_cell != 20)
      refuse("cells of " + std::to_string(nodes_per_cell) + " nodes", "4, 8, 10 or 20 are known");
    constexpr std::size_t most = std::numeric_limits<std::int32_t>::max() / 20;
    if (node_count > most || cell_count > most)
      palpate::raise(SetupErrorKind::count_too_large, "more than " + std::to_string(most) + " nodes or cells");
    const auto numbers_per_cell = static_cast<std::size_t>(nodes_per_cell);
    const auto x = numbers(positions, 3 * node_count, "positions");
    const auto ids = numbers(cells, numbers_per_cell * cell_count, "cells");
    auto made = std::make_unique<palpate_mesh>();
    palpate::detail::PlainMesh& plain = made->given.plain;
    made->given.nodes_per_cell = nodes_per_cell;
    for (std::size_t i = 0; i < node_count; ++i) plain.positions.emplace_back(x[3 * i], x[3 * i + 1], x[3 * i + 2]);
    plain.connectivity.assign(ids.begin(), ids.end());
    take_regions({regions, regions == nullptr ? 0 : cell_count}, cell_count, plain);
    out = made.release();
  });
}

palpate_error palpate_mesh_add_group(palpate_mesh* mesh, const char* name, const int32_t* nodes, size_t count) {
  using namespace palpate::c_interface;
  return guarded([&] { add_group(object(mesh, "mesh").given, text(name, "name"), numbers(nodes, count, "nodes")); });
}

palpate_error palpate_mesh_add_group_in_box(palpate_mesh* mesh, const char* name, const double* low,
                                            const double* high) {
  using namespace palpate::c_interface;
  return guarded([&] {
    GivenMesh& given = object(mesh, "mesh").given;
    const palpate::Vector3 a(numbers(low, 3, "low").data()), b(numbers(high, 3, "high").data());
    std::vector<std::int32_t> inside;
    for (palpate::Index i = 0; i < given.node_count(); ++i) {
      const palpate::Vector3 x = given.position(i);
      if ((x.array() >= a.array()).all() && (x.array() <= b.array()).all())
        inside.push_back(static_cast<std::int32_t>(i));
    }
    const std::string group = text(name, "name");
    if (inside.empty())
      palpate::raise(palpate::SetupErrorKind::empty_group, "no node is in the box of group '" + group + "'",
                     "palpate_mesh_extent returns where the mesh is");
    add_group(given, group, inside);
  });
}

palpate_error palpate_mesh_extent(const palpate_mesh* mesh, size_t* node_count, double* low, double* high) {
  using namespace palpate::c_interface;
  return guarded([&] {
    const GivenMesh& given = object(mesh, "mesh").given;
    if (node_count != nullptr) *node_count = static_cast<size_t>(given.node_count());
    palpate::Vector3 a = palpate::Vector3::Zero(), b = a;
    for (palpate::Index i = 0; i < given.node_count(); ++i) {
      const palpate::Vector3 x = given.position(i);
      a = i == 0 ? x : palpate::Vector3(a.cwiseMin(x));
      b = i == 0 ? x : palpate::Vector3(b.cwiseMax(x));
    }
    if (low != nullptr) std::copy_n(a.data(), 3, low);
    if (high != nullptr) std::copy_n(b.data(), 3, high);
  });
}

void palpate_mesh_destroy(palpate_mesh* mesh) {
  if (mesh == nullptr || mesh->tag.value != palpate_mesh::kind) return;
  mesh->tag.value = 0;
  delete mesh;
}

}  // extern "C"
