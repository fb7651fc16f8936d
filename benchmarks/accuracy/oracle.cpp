// Linear static cases of other codes, read from files: the same mesh and element must give the same displacement.
#include "elements.hpp"
#include "parts.hpp"

#if __has_include(<nlohmann/json.hpp>)

#include "../../examples/solve_case/case_file.hpp"

#include <palpate/io/detail/text_reader.hpp>

#include <filesystem>
#include <fstream>
#include <map>

namespace accuracy {

namespace {

using nlohmann::json;
namespace fs = std::filesystem;

/// Largest relative difference between the displacements of two codes, by "case/mesh load_case".
std::map<std::string, std::string> read_disagreement(const fs::path& index) {
  std::map<std::string, std::string> found;
  std::ifstream file(index);
  for (std::string line; std::getline(file, line);) {
    std::vector<std::string> cells(1);
    bool quoted = false;
    for (const char c : line) {
      if (c == '"') quoted = !quoted;
      if (c == ',' && !quoted)
        cells.emplace_back();
      else
        cells.back() += c;
    }
    if (cells.size() > 8) found[cells[0] + ' ' + cells[1]] = cells[8];
  }
  return found;
}

/// Displacements by node id.
std::map<Index, Vector3> read_displacements(const fs::path& path) {
  std::string text = io::read_file(path.string());
  std::ranges::replace(text, ',', ' ');
  io::TextReader in(text, path.string());
  in.need_line("a header");
  std::map<Index, Vector3> rows;
  while (in.next_line()) {
    const Index id = in.integer("a node id", 1, std::numeric_limits<Index>::max());
    for (int skipped = 0; skipped < 3; ++skipped) in.real("a coordinate");
    Vector3& u = rows[id];
    for (double& c : u) c = in.real("a displacement");
  }
  return rows;
}

/// Fixes nodes that belong to no element, which a mesh file may contain.
template <Element E>
void fix_lone_nodes(const Mesh<E>& mesh, Scene& scene) {
  std::vector<bool> used(static_cast<std::size_t>(mesh.node_count()), false);
  for (const auto& element : mesh.elements)
    for (const NodeId i : element) used[static_cast<std::size_t>(i)] = true;
  for (NodeId i = 0; i < mesh.node_count(); ++i)
    if (!used[static_cast<std::size_t>(i)]) scene.fix(std::vector<NodeId>{i});
}

template <Element E>
Body<E> read_body(const Mesh<E>& mesh, const json& load_case, const Scene& scene) {
  Body<E> body = make_body(mesh, solve_case::read_materials(load_case));
  body.initial_strain = detail::initial_strains_by_region(mesh, scene);
  return body;
}

/// Largest difference of a displacement component, relative to the largest component.
template <Element E>
double difference(const Mesh<E>& mesh, const json& load_case, const std::map<Index, Vector3>& reference,
                  const std::vector<Index>& tags) {
  solve_case::check_analysis(load_case, solve_case::statics);
  Scene scene = solve_case::read_scene(load_case, mesh);
  const Body<E> body = read_body(mesh, load_case, scene);
  fix_lone_nodes(mesh, scene);
  const VectorX u = solve(body, scene).displacement;
  double worst = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < tags.size(); ++i) {
    const auto row = reference.find(tags[i]);
    if (row == reference.end()) continue;
    const double d = (u.segment<3>(3 * static_cast<Index>(i)) - row->second).cwiseAbs().maxCoeff();
    worst = std::isfinite(d) ? std::max(worst, d) : infinity;
    largest = std::max(largest, row->second.cwiseAbs().maxCoeff());
  }
  return worst / largest;
}

template <Element E>
void compare_folder(const fs::path& root, const fs::path& folder, const solve_case::CaseFile& file, Table& table,
                    const std::map<std::string, std::string>& disagreement, Checks& checks) {
  io::MeshNumbering ids;
  const Mesh<E> mesh = io::read_mesh<E>(file.mesh_v22, 1.0, &ids);
  const std::vector<Index> tags(ids.node_tags.begin(), ids.node_tags.end());
  const std::string name = fs::relative(folder, root).generic_string();
  for (const json& load_case : file.load_cases) {
    const auto which = load_case.at("name").get<std::string>();
    const fs::path reference = folder / (which + "_u.csv");
    if (load_case.at("analysis") != solve_case::statics || !fs::exists(reference)) continue;
    const double error = difference(mesh, load_case, read_displacements(reference), tags);
    const auto other = disagreement.find(name + ' ' + which);
    table.add({name, which, element_name<E>(), std::to_string(mesh.node_count()), text(error, "%.1e"),
               other == disagreement.end() ? "-" : other->second});
    checks.expect(error <= 1e-6, name + ' ' + which + ": differs by more than 1e-6 from the reference");
  }
}

}  // namespace

void compare_with_oracle(const std::string& folder, Checks& checks) {
  std::printf(
      "## Against other codes\n\nLargest difference of displacement to CalculiX (which prints seven digits), relative "
      "to the largest displacement; in the last column the same for a second code (GetFEM).\n\n");
  Table table({"case", "load case", "element", "nodes", "ours", "second code"});
  const auto disagreement = read_disagreement(fs::path(folder) / "index.csv");
  std::vector<fs::path> folders;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().filename() == "case.json") folders.push_back(entry.path().parent_path());
  std::ranges::sort(folders);
  int found = 0;
  for (const fs::path& one : folders) {
    const auto file = solve_case::read_case_files((one / "case.json").string()).front();
    each_element([&]<class E>(std::type_identity<E>) {
      std::string plain = element_name<E>();
      std::ranges::transform(plain, plain.begin(),
                             [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
      if (plain != file.element) return;
      ++found;
      compare_folder<E>(folder, one, file, table, disagreement, checks);
    });
  }
  table.print();
  checks.expect(found > 0, "no case in " + folder);
}

}  // namespace accuracy

#else

void accuracy::compare_with_oracle(const std::string&, Checks&) {
  std::printf("## Against other codes\n\nLeft out: nlohmann-json was not found at compile time.\n\n");
}

#endif
