// Reads a case file: load cases on one mesh, as JSON. All supported keys are listed here; others are refused, not
// skipped.
#pragma once

#include <palpate/elements.hpp>
#include <palpate/io.hpp>
#include <palpate/palpate.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <initializer_list>

namespace solve_case {

using nlohmann::json;
using palpate::SetupErrorKind;
using Materials = palpate::RegionMaterials<palpate::LinearElastic>;

/// A case file: the element type, the mesh files in its folder, and the load cases as JSON.
struct CaseFile {
  std::string title;
  std::string element;  ///< "tet4", "tet10", "hex8", "hex20"
  std::string mesh_v22, mesh_v41;
  std::vector<json> load_cases;
};

/// Runs `read`; a missing key or a wrong type becomes a SetupError(bad_file).
template <class Read>
auto checked(const std::string& where, Read read) {
  try {
    return read();
  } catch (const json::exception& error) {
    palpate::raise(SetupErrorKind::bad_file, where + ": " + error.what());
  }
}

/// Refuses keys that are not in the list.
inline void allow_keys(const json& object, const std::string& where, std::initializer_list<std::string_view> known) {
  for (const auto& [key, value] : object.items())
    if (std::ranges::find(known, key) == known.end())
      palpate::raise(SetupErrorKind::unsupported, where + " has the unknown key '" + key + "'");
}

inline palpate::Vector3 read_vector(const json& list) {
  if (list.size() != 3)
    palpate::raise(SetupErrorKind::bad_file, "a vector has " + std::to_string(list.size()) + " components");
  return {list.at(0).get<double>(), list.at(1).get<double>(), list.at(2).get<double>()};
}

inline CaseFile case_file_on(const json& mesh, const std::filesystem::path& folder) {
  CaseFile read;
  const json files = mesh.value("files", json::object());
  read.element = mesh.at("element").get<std::string>();
  read.mesh_v22 = (folder / files.value("msh22", "mesh_v22.msh")).string();
  read.mesh_v41 = (folder / files.value("msh41", "mesh_v41.msh")).string();
  return read;
}

inline constexpr const char* cube_in_time = "viscoelastic cube";
inline constexpr const char* bar_in_time = "bar in motion";

/// A viscoelastic cube under constant strain, load or oscillation: every loading with every material law becomes a load
/// case, on each of the existing meshes.
inline std::vector<CaseFile> read_cube_in_time(const json& file, const std::filesystem::path& folder) {
  std::vector<CaseFile> read;
  for (const auto& [element, variant] : file.at("meshes").items()) {
    if (!std::filesystem::exists(folder / element)) continue;
    read.push_back(case_file_on(variant.at("mesh"), folder / element));
    const std::string before = element + "__";
    const auto add = [&](const std::string& material, const std::string& hold, const std::string& table) {
      read.back().load_cases.push_back({{"name", before + material + "__" + hold},
                                        {"analysis", cube_in_time},
                                        {"material", file.at("material")},
                                        {"law", material},
                                        {"hold", hold},
                                        {"table", (folder / file.at("files").at(table).get<std::string>()).string()}});
    };
    for (const auto& [material, text] : file.at("material").at("laws").items())
      for (const auto& [hold, what] : file.at("cases").items()) add(material, hold, "relaxation");
    for (const char* hold : {"ramp_shear", "ramp_uniaxial", "creep"}) add("all_moduli", hold, "ramp_creep");
    add("shear_only", "harmonic", "harmonic");
  }
  return read;
}

/// A bar under a suddenly applied tension, on each of the existing meshes.
inline std::vector<CaseFile> read_bar_in_time(const json& file, const std::filesystem::path& folder) {
  std::vector<CaseFile> read;
  for (const auto& [element, variant] : file.at("variants").items()) {
    const auto own = folder / ("bar_" + element);
    if (!std::filesystem::exists(own)) continue;
    read.push_back(case_file_on(variant.at("mesh"), own));
    read.back().load_cases.push_back({{"name", "bar_" + element},
                                      {"analysis", bar_in_time},
                                      {"material", file.at("material")},
                                      {"tip_maximum", file.at("closed_form").at("tip_maximum")},
                                      {"dt", variant.at("dt")},
                                      {"table", (own / "history.csv").string()}});
  }
  return read;
}

/// Reads the file, one CaseFile per mesh; for unknown kinds of files it has no load cases. Throws SetupError(bad_file).
inline std::vector<CaseFile> read_case_files(const std::string& path) {
  const std::string text = palpate::io::read_file(path);
  return checked(path, [&] {
    const json file = json::parse(text);
    const auto folder = std::filesystem::path(path).parent_path();
    std::vector<CaseFile> read;
    if (file.contains("load_cases")) {
      read.push_back(case_file_on(file.at("mesh"), folder));
      read.back().load_cases = file.at("load_cases").get<std::vector<json>>();
    } else if (file.contains("cases") && file.contains("meshes") && file.at("material").contains("laws")) {
      read = read_cube_in_time(file, folder);
    } else if (file.contains("variants") && file.contains("wave_speed")) {
      read = read_bar_in_time(file, folder);
    }
    if (read.empty()) read.emplace_back();
    for (CaseFile& c : read) c.title = file.value("title", path);
    return read;
  });
}

inline constexpr const char* statics = "linear static, small strain";
inline constexpr const char* large_strain_statics = "geometrically non-linear static, dead loads";
inline constexpr const char* eigenfrequencies = "linear eigenfrequency";

/// Refuses another analysis than the expected one, and keys that do not belong to it.
inline void check_analysis(const json& load_case, const char* wanted) {
  allow_keys(load_case, "the load case",
             {"name", "title", "analysis", "materials", "boundary_conditions", "reference", "crosscheck", "closed_form",
              wanted == eigenfrequencies ? "modes" : "loads"});
  const auto analysis = load_case.at("analysis").get<std::string>();
  if (analysis != wanted)
    palpate::raise(
        SetupErrorKind::unsupported, "the analysis '" + analysis + "'",
        "'" + std::string(statics) + "', '" + large_strain_statics + "' and '" + eigenfrequencies + "' are supported");
}

/// The material of each region.
inline Materials read_materials(const json& load_case) {
  Materials materials;
  for (const auto& [region, m] : load_case.at("materials").items()) {
    const auto model = m.at("model").get<std::string>();
    if (model != "linear_elastic") palpate::raise(SetupErrorKind::unsupported, "the material model '" + model + "'");
    allow_keys(m, "material '" + region + "'", {"model", "E", "nu", "rho", "alpha_T"});
    materials.emplace_back(region, palpate::LinearElastic{.youngs_modulus = m.at("E").get<double>(),
                                                          .poisson_ratio = m.at("nu").get<double>(),
                                                          .density = m.value("rho", 0.0)});
  }
  return materials;
}

/// A group of the mesh by its name, or, for `boundary_nodes_at_y=0.5`, the nodes of the boundary with that coordinate.
template <palpate::Element E>
palpate::Selection read_selection(const std::string& name, const palpate::Mesh<E>& mesh) {
  const std::string prefix = "boundary_nodes_at_";
  if (!name.starts_with(prefix)) return name;
  double value = 0.0;
  const std::size_t axis = std::string("xyz").find(name.substr(prefix.size(), 1));
  if (axis > 2 || name.substr(prefix.size() + 1, 1) != "=" ||
      palpate::io::parse_decimal(std::string_view(name).substr(prefix.size() + 2), value) != std::errc{})
    palpate::raise(SetupErrorKind::unknown_group, "'" + name + "' is not like boundary_nodes_at_y=0.5");
  double size = 0.0;
  for (const auto& x : mesh.positions) size = std::max(size, x.cwiseAbs().maxCoeff());
  std::vector<palpate::NodeId> nodes;
  for (const palpate::NodeId i : palpate::nodes_of(palpate::extract_boundary<E>(mesh)))
    if (std::abs(mesh.position(i)[static_cast<int>(axis)] - value) <= 1e-9 * size) nodes.push_back(i);
  return nodes;
}

/// The initial strain alpha_T of every region: one number for all directions, or three diagonal values.
inline void read_initial_strain(palpate::Scene& scene, const json& load, const json& materials) {
  const auto form = load.at("eps0").get<std::string>();
  for (const auto& [region, m] : materials.items()) {
    const json& alpha = m.at("alpha_T");
    if (form != (alpha.is_array() ? "diag(alpha_T)" : "alpha_T*I"))
      palpate::raise(SetupErrorKind::unsupported, "the initial strain '" + form + "' of region '" + region + "'");
    palpate::Vector6 strain = palpate::Vector6::Zero();
    strain.head<3>() = alpha.is_array() ? read_vector(alpha) : palpate::Vector3::Constant(alpha.get<double>());
    scene.initial_strain(region, strain);
  }
}

template <palpate::Element E>
void read_load(palpate::Scene& scene, const json& load, const json& materials, const palpate::Mesh<E>& mesh) {
  const auto type = load.at("type").get<std::string>();
  const auto where = [&] { return read_selection(load.at("group").get<std::string>(), mesh); };
  if (type == "point") {
    allow_keys(load, "a point load", {"type", "group", "force"});
    scene.point_load(where(), read_vector(load.at("force")));
  } else if (type == "traction") {
    allow_keys(load, "a traction", {"type", "group", "traction"});
    scene.traction(where(), read_vector(load.at("traction")));
  } else if (type == "pressure") {
    allow_keys(load, "a pressure", {"type", "group", "pressure"});
    scene.pressure(where(), load.at("pressure").get<double>());
  } else if (type == "gravity") {
    allow_keys(load, "gravity", {"type", "g"});
    for (const auto& [region, m] : materials.items())
      if (!m.contains("rho"))
        palpate::raise(SetupErrorKind::bad_density, "there is gravity, but material '" + region + "' has no rho");
    scene.gravity(read_vector(load.at("g")));
  } else if (type == "initial_strain") {
    allow_keys(load, "an initial strain", {"type", "eps0"});
    read_initial_strain(scene, load, materials);
  } else {
    palpate::raise(SetupErrorKind::unsupported, "the load type '" + type + "'");
  }
}

/// The constraints. A component that is null is free.
template <palpate::Element E>
palpate::Scene read_supports(const json& load_case, const palpate::Mesh<E>& mesh) {
  palpate::Scene scene;
  for (const json& condition : load_case.at("boundary_conditions")) {
    allow_keys(condition, "a boundary condition", {"group", "u"});
    const json& u = condition.at("u");
    if (u.size() != 3) palpate::raise(SetupErrorKind::bad_file, "a boundary condition needs three components");
    palpate::Components values;
    for (std::size_t c = 0; c < 3; ++c)
      if (!u.at(c).is_null()) values[c] = u.at(c).get<double>();
    scene.prescribe(read_selection(condition.at("group").get<std::string>(), mesh), values);
  }
  return scene;
}

/// Constraints and loads.
template <palpate::Element E>
palpate::Scene read_scene(const json& load_case, const palpate::Mesh<E>& mesh) {
  palpate::Scene scene = read_supports(load_case, mesh);
  int gravities = 0;
  for (const json& load : load_case.at("loads")) {
    gravities += load.at("type") == "gravity" ? 1 : 0;
    if (gravities > 1) palpate::raise(SetupErrorKind::unsupported, "gravity twice in one load case");
    read_load(scene, load, load_case.at("materials"), mesh);
  }
  return scene;
}

}  // namespace solve_case
