// Natural frequencies against those of another code (GetFEM, exactly integrated consistent mass).
#include "../../examples/solve_case/modes.hpp"
#include "properties/oracle_checks.hpp"

using namespace palpate;
using solve_case::json;

namespace {

/// Distance of a reference shape from the span of the modes with its frequency, over its length. Modes of a pair are
/// any basis of their span.
template <Element E>
double distance(const test::Table& reference, const solve_case::NumberedMesh<E>& mesh, const solve_case::Modes& modes,
                Index k) {
  const VectorX& f = modes.found.frequencies;
  VectorX shape = VectorX::Zero(modes.found.shapes.rows());
  for (std::size_t i = 0; i < modes.node_map.size(); ++i) {
    const auto& row = reference.at(mesh.ids.node_tags[i]);
    shape.segment<3>(3 * modes.node_map[i]) = Vector3(row.at(3), row.at(4), row.at(5));
  }
  std::vector<Index> pair;
  for (Index j = 0; j < f.size(); ++j)
    if (std::abs(f[j] - f[k]) <= 1e-6 * f[k]) pair.push_back(j);
  const MatrixX span = modes.found.shapes(Eigen::all, pair);
  const VectorX best = span * (span.transpose() * span).ldlt().solve(span.transpose() * shape);
  return (shape - best).norm() / shape.norm();
}

template <Element E>
int check_modes(const std::string& folder, const std::string& element, double tolerance) {
  return test::each_load_case<E>(
      folder, element, solve_case::eigenfrequencies, [&](const auto& mesh, const json& load_case) {
        const auto modes = solve_case::solve_modes<E>(mesh.mesh, load_case);
        const json& scalars = load_case.at("reference").at("scalars");
        const auto frequencies = scalars.at("elastic_frequencies_hz").template get<std::vector<double>>();
        INFO(folder);
        CHECK(modes.found.rigid_modes() == (scalars.at("rigid").is_null() ? 0 : 6));
        REQUIRE(modes.found.frequencies.size() == static_cast<Index>(frequencies.size()));
        for (std::size_t k = 0; k < frequencies.size(); ++k)
          CHECK_THAT(modes.found.frequencies[static_cast<Index>(k)],
                     Catch::Matchers::WithinRel(frequencies[k], tolerance));
        for (Index k : {0, 1}) {
          const std::string shape = folder + "/mode" + std::to_string(k + 1) + "_u.csv";
          if (std::filesystem::exists(shape)) CHECK(distance(test::read_csv(shape), mesh, modes, k) <= 1e-6);
        }
      });
}

}  // namespace

TEST_CASE("Natural frequencies agree with the reference results in the tree", "[oracle][modal]") {
  CHECK(check_modes<Tet4>(PALPATE_TEST_DATA "/oracle/I_modal/cantilever_tet4", "tet4", 1e-8) == 1);
  CHECK(check_modes<Tet10>(PALPATE_TEST_DATA "/oracle/I_modal/block_tet10", "tet10", 1e-8) == 1);
}

TEST_CASE("Natural frequencies agree with all further reference results", "[oracle][modal]") {
  const int checked = test::each_reference_folder([](const std::string& folder) {
    return check_modes<Tet4>(folder, "tet4", 1e-8) + check_modes<Tet10>(folder, "tet10", 1e-8) +
           check_modes<Hex8>(folder, "hex8", 1e-8) + check_modes<Hex20>(folder, "hex20", 1e-8);
  });
  if (checked < 0) WARN(test::no_further_results);
  CHECK(checked != 0);
}

TEST_CASE("A modal load case with unknown content is refused", "[oracle][modal]") {
  const auto file = solve_case::read_case_files(PALPATE_TEST_DATA "/oracle/I_modal/cantilever_tet4/case.json").front();
  const auto mesh = io::read_mesh<Tet4>(file.mesh_v22);
  const auto refusal = [&](const char* pointer, const json& value) {
    json changed = file.load_cases.front();
    changed[json::json_pointer(pointer)] = value;
    try {
      solve_case::checked("case", [&] { return solve_case::solve_modes<Tet4>(mesh, changed); });
    } catch (const SetupError& error) {
      return error.kind();
    }
    FAIL("accepted");
    return SetupErrorKind{};
  };
  CHECK(refusal("/analysis", "linear static, small strain") == SetupErrorKind::unsupported);
  CHECK(refusal("/analysis", "modal dynamics") == SetupErrorKind::unsupported);
  CHECK(refusal("/loads", json::array({{{"type", "gravity"}, {"g", {0, 0, -9.81}}}})) == SetupErrorKind::unsupported);
  CHECK(refusal("/damping", 0.1) == SetupErrorKind::unsupported);
  CHECK(refusal("/modes", 0) == SetupErrorKind::bad_argument);
  CHECK(refusal("/modes", 100000) == SetupErrorKind::count_too_large);
  CHECK(refusal("/materials/body/rho", 0.0) == SetupErrorKind::bad_density);
}
