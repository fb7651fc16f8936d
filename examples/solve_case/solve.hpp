// Solves one load case with elements E and writes the results.
#pragma once

#include "case_file.hpp"

#include <palpate/mesh/selection.hpp>

#include <chrono>
#include <fstream>
#include <iomanip>

namespace solve_case {

/// A mesh and the node ids of its file.
template <palpate::Element E>
struct NumberedMesh {
  palpate::Mesh<E> mesh;
  palpate::io::MeshNumbering ids;
};

/// The static state of a load case. Vectors are 3 x nodes of the model, node by node; `node_map` maps the nodes of the
/// mesh file to them, -1 for nodes of no element, which the model drops.
struct Solution {
  palpate::VectorX displacement, internal_force, reactions;
  double strain_energy = 0.0;
  std::vector<palpate::NodeId> node_map;
  std::vector<palpate::NodeId> constrained;  ///< nodes of the file with a prescribed component
  double seconds = 0.0;
};

/// Nodes of a mesh with a prescribed component, ascending.
template <palpate::Element E>
std::vector<palpate::NodeId> constrained_nodes(const palpate::Mesh<E>& mesh, const palpate::Scene& scene) {
  std::vector<palpate::NodeId> constrained;
  const auto boundary = palpate::extract_boundary<E>(mesh);
  for (const auto& condition : scene.prescribed())
    for (const palpate::NodeId i : palpate::resolve_nodes(mesh, boundary, condition.where)) constrained.push_back(i);
  std::ranges::sort(constrained);
  constrained.erase(std::unique(constrained.begin(), constrained.end()), constrained.end());
  return constrained;
}

/// Sets up the model of a load case, which solves it. Throws SetupError.
template <palpate::Element E>
Solution solve(const palpate::Mesh<E>& mesh, const json& load_case) {
  using Model = palpate::HapticFEModel<E, palpate::LinearElastic, palpate::SparseCholesky>;
  check_analysis(load_case, statics);
  const palpate::Scene scene = read_scene(load_case, mesh);
  const Materials materials = read_materials(load_case);

  const auto start = std::chrono::steady_clock::now();
  Model model(mesh, scene, materials, palpate::SetupOptions{});
  Solution s{model.displacement(),
             model.internal_force(),
             model.reactions(),
             model.strain_energy(),
             model.node_map(),
             constrained_nodes(mesh, scene),
             0.0};
  s.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return s;
}

/// Opens DIR/<name> for writing numbers with 16 significant digits.
inline std::ofstream open_csv(const std::filesystem::path& path, const char* header) {
  std::ofstream file(path);
  if (!file) palpate::raise(SetupErrorKind::bad_file, path.string() + ": cannot be opened for writing");
  file << header << '\n' << std::scientific << std::setprecision(15);
  return file;
}

inline void write_triple(std::ostream& out, const palpate::Vector3& v) {
  out << ',' << v[0] << ',' << v[1] << ',' << v[2];
}

/// Writes three numbers per node of the model, in rows `node,x,y,z,...` with the node ids of the mesh file.
template <palpate::Element E>
void write_nodes(const std::filesystem::path& path, const NumberedMesh<E>& numbered,
                 const std::vector<palpate::NodeId>& node_map, const palpate::VectorX& values) {
  std::ofstream u = open_csv(path, "node,x,y,z,ux,uy,uz");
  for (palpate::Index i = 0; i < numbered.mesh.node_count(); ++i) {
    const palpate::Index k = node_map[static_cast<std::size_t>(i)];
    if (k < 0) continue;
    u << numbered.ids.node_tags[static_cast<std::size_t>(i)];
    write_triple(u, numbered.mesh.position(i));
    write_triple(u, values.segment<3>(3 * k));
    u << '\n';
  }
  if (!u.flush()) palpate::raise(SetupErrorKind::bad_file, path.string() + ": writing failed");
}

/// Writes <name>_u.csv and <name>_reactions.csv.
template <palpate::Element E>
void write_csv(const std::filesystem::path& folder, const std::string& name, const NumberedMesh<E>& numbered,
               const Solution& s) {
  write_nodes(folder / (name + "_u.csv"), numbered, s.node_map, s.displacement);
  std::ofstream r = open_csv(folder / (name + "_reactions.csv"), "node,rx,ry,rz,ix,iy,iz");
  for (const palpate::NodeId i : s.constrained) {
    const palpate::Index k = s.node_map[static_cast<std::size_t>(i)];
    if (k < 0) continue;
    r << numbered.ids.node_tags[static_cast<std::size_t>(i)];
    write_triple(r, s.reactions.segment<3>(3 * k));
    write_triple(r, s.internal_force.segment<3>(3 * k));
    r << '\n';
  }
  if (!r.flush()) palpate::raise(SetupErrorKind::bad_file, folder.string() + ": writing failed");
}

/// The line printed for a solved load case.
inline nlohmann::ordered_json summary(const std::string& name, const std::string& element, const Solution& s) {
  double largest = 0.0;
  palpate::Vector3 sum = palpate::Vector3::Zero();
  for (palpate::Index i = 0; i < s.displacement.size() / 3; ++i) {
    largest = std::max(largest, s.displacement.segment<3>(3 * i).norm());
    sum += s.reactions.segment<3>(3 * i);
  }
  return {{"case", name},
          {"element", element},
          {"max_abs_displacement", largest},
          {"strain_energy", s.strain_energy},
          {"sum_of_reactions", {sum[0], sum[1], sum[2]}},
          {"seconds", s.seconds}};
}

}  // namespace solve_case
