// The whole library without exceptions and RTTI. The first argument selects the case: `valid` constructs a tissue and
// touches it, which must work; `invalid` constructs one with a Poisson ratio of 0.5, `inverted` one with an inverted
// element: both must call the handler (exit code 7). `default` is `invalid` with the default handler, `returns` with a
// handler that returns: both print and abort.
#include <palpate/palpate.hpp>
#include <palpate/soft.hpp>

#include <cstdio>
#include <cstdlib>
#include <cstring>

#if defined(__cpp_exceptions) || defined(__cpp_rtti)
#error "compile this without exceptions and without RTTI"
#endif

namespace {

using Tissue =
    palpate::HapticFEModel<palpate::Tet4, palpate::LinearElastic, palpate::Condensed<palpate::SelectiveInverse>>;

void show(const palpate::SetupProblem& problem) {
  std::printf("handler: %s, value %g, threshold %g, count %lld, ids", to_string(problem.kind).data(), problem.value,
              problem.threshold, static_cast<long long>(problem.count));
  for (const auto id : problem.ids) std::printf(" %lld", static_cast<long long>(id));
  std::printf("\n");
  std::fflush(stdout);
}
void show_and_exit(const palpate::SetupProblem& problem) {
  show(problem);
  std::_Exit(7);
}

/// The vertical force [N] on a sphere of 5 mm radius pressed 2 mm into a pad of this Poisson ratio.
double press(double poisson_ratio, bool invert) {
  auto mesh = palpate::box_tet4({0.04, 0.04, 0.02}, {4, 4, 2});
  if (invert) std::swap(mesh.elements[3][0], mesh.elements[3][1]);
  palpate::Scene scene;
  scene.fix("z0").touch("z1");
  Tissue tissue(mesh, scene, palpate::LinearElastic{.youngs_modulus = 5e3, .poisson_ratio = poisson_ratio});
  palpate::HapticServo servo(tissue, palpate::SphereTool{.radius = 5e-3});
  double force = 0.0;
  for (int i = 0; i <= 1000; ++i) {
    palpate::ToolState tool;
    tool.time = 1e-3 * i;
    tool.position = {0.02, 0.02, 0.026 - 3e-6 * i};
    force = servo.tick({&tool, 1})[0].force()[2];
  }
  return force;
}

}  // namespace

int main(int count, char** values) {
  const char* what = count == 2 ? values[1] : "";
  if (std::strcmp(what, "default") != 0) palpate::setup_failure_handler() = show_and_exit;
  if (std::strcmp(what, "returns") == 0) palpate::setup_failure_handler() = show;
  const bool invert = std::strcmp(what, "inverted") == 0;
  const double force = press(std::strcmp(what, "valid") == 0 || invert ? 0.3 : 0.5, invert);
  std::printf("force %.6f N\n", force);
  return force > 0.03 && force < 1.0 ? 0 : 1;
}
