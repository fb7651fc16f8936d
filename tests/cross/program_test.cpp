// The program of a scene: short where the scene is plain, with the types of its words.
#include "program.hpp"

#include <algorithm>
#include <map>

#include "catch.hpp"

using namespace cross;

namespace {

void check_balance(const std::string& program) {
  for (const char* pair : {"{}", "()"})
    CHECK(std::ranges::count(program, pair[0]) == std::ranges::count(program, pair[1]));
}

/// Every word of an axis gives its type; `set` puts the word into a scene.
template <class Set>
void check_types(const char* axis, const std::map<std::string, std::string>& types, const Set& set) {
  REQUIRE(types.size() == words_of(axis).size());
  for (const std::string& word : words_of(axis)) {
    INFO(axis << ' ' << word);
    Scene scene;
    scene.cells_x = scene.cells_y = scene.cells_z = 2;
    set(scene, word);
    const std::string program = to_program(scene);
    CHECK_THAT(program, test::contains(types.at(word)));
    check_balance(program);
  }
}

}  // namespace

TEST_CASE("the program of the plainest scene is short", "[cross]") {
  const std::string program = to_program({});
  CHECK(std::ranges::count(program, '\n') < 45);
  CHECK_THAT(program, test::contains("HapticFEModel<Tet4, LinearElastic, Condensed<SelectiveInverse>>"));
  CHECK_THAT(program, test::contains("SphereTool{.radius = 0.006}"));
  for (const char* unused : {"friction", "gravity", "pressure", "set_pose", "TissueGroup", "background_work"})
    CHECK_THAT(program, !test::contains(unused));
  check_balance(program);
}

TEST_CASE("the program of a scene has the type of every element", "[cross]") {
  check_types("element",
              {{"tet4", "<Tet4, "},
               {"smoothed_tet4", "<Smoothed<Tet4>, "},
               {"tet10", "<Tet10, "},
               {"hex8", "<Hex8, "},
               {"hex20", "<Hex20, "},
               {"mean_dilatation_hex8", "<MeanDilatation<Hex8>, "}},
              [](Scene& scene, const std::string& word) { scene.element = word; });
}

TEST_CASE("the program of a scene has the type of every law", "[cross]") {
  check_types("law",
              {{"linear", ", LinearElastic, "},
               {"transversely_isotropic", ", TransverselyIsotropic, "},
               {"orthotropic", ", Orthotropic, "},
               {"corotational", ", Corotational, "},
               {"st_venant_kirchhoff", ", StVenantKirchhoff, "},
               {"neo_hookean", ", NeoHookean, "},
               {"neo_hookean_logarithmic", ", NeoHookeanLogarithmic, "},
               {"neo_hookean_isochoric", ", NeoHookeanIsochoric, "},
               {"mooney_rivlin", ", MooneyRivlin, "},
               {"fibre_reinforced", ", FibreReinforced<NeoHookean>, "},
               {"viscoelastic", ", Viscoelastic<NeoHookean, 1>, "}},
              [](Scene& scene, const std::string& word) { scene.law = word; });
}

TEST_CASE("the program of a scene has the type of every solver", "[cross]") {
  check_types("solver",
              {{"condensed", ", Condensed<SelectiveInverse>>;"},
               {"condensed_float", ", Condensed<SelectiveInverseFloat>>;"},
               {"condensed_cholesky", ", Condensed<DenseCholesky>>;"},
               {"condensed_cg", ", Condensed<ConjugateGradient>>;"},
               {"sparse_cholesky", ", SparseCholesky>;"},
               {"cg", ", ConjugateGradient>;"},
               {"matrix_free_cg", ", WithAssembly<ConjugateGradient, MatrixFree>>;"},
               {"inverse", ", SelectiveInverse>;"},
               {"stiffening", ", Stiffening<Condensed<SelectiveInverse>>>;"},
               {"newton", ", Implicit<Newton>>;"},
               {"corotated_cg", ", Implicit<MatrixFreeCG<BlockJacobi>>>;"},
               {"quasi_newton", ", Implicit<QuasiNewton<double>>>;"},
               {"quasi_newton_float", ", Implicit<QuasiNewton<float>>>;"},
               {"central_difference", ", Explicit<CentralDifference>>;"},
               {"semi_implicit_euler", ", Explicit<SemiImplicitEuler>>;"},
               {"cut_condensed", ", Cuttable<Condensed<SelectiveInverse>>>;"},
               {"cut_quasi_newton", ", Cuttable<Implicit<QuasiNewton<double>>>>;"},
               {"cut_quasi_newton_float", ", Cuttable<Implicit<QuasiNewton<float>>>>;"}},
              [](Scene& scene, const std::string& word) { scene.solver = word; });
}

TEST_CASE("the program of a scene has the lines of every body, region, load, tool and path", "[cross]") {
  for (const char* axis : {"body", "regions", "touched", "support", "load", "pose", "member", "kind", "path"})
    for (const std::string& word : words_of(axis)) {
      INFO(axis << ' ' << word);
      Scene scene;
      scene.contrast = 10.0, scene.load_size = 0.05, scene.slivers = 1;
      scene.tools.emplace_back();
      const auto set = [&](const char* name, auto& value) {
        if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::string>)
          if (name == std::string(axis)) value = word;
      };
      visit(scene, set), visit_tool(scene.tools[1], set);
      check_balance(to_program(scene));
    }
}
