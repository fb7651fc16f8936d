// Statics, a factorisation, a contact force through the gate: a few numbers, printed, and compared with the arguments.
// Returns 1 when one differs by more than rounding, or when the gate outputs a force that it must not.
#include <palpate/assembly/assembled.hpp>
#include <palpate/assembly/free_stiffness.hpp>
#include <palpate/core/platform.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/haptic/force_gate.hpp>
#include <palpate/linear/sparse_cholesky.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/generators.hpp>

#include <cstdio>
#include <cstdlib>

using namespace palpate;

namespace {

/// Largest displacement and energy of a block that is fixed at one side and loaded.
std::array<double, 2> statics() {
  const auto mesh = box_tet4({0.1, 0.08, 0.06}, {4, 3, 3});
  const auto body = make_body(mesh, std::vector<LinearElastic>{{5e3, 0.45, 1000.0}});
  const auto conditions = resolve_essential(body.mesh, extract_boundary<Tet4>(body.mesh), Scene().fix("x0"));
  const SparseMatrix lower = free_matrix(assemble_stiffness<Tet4>(body, {}), conditions);
  DofLayout layout;
  layout.positions = mesh.positions;
  for (Index dof : conditions.free_dofs) layout.node_of_dof.push_back(dof / 3);
  SparseCholesky solver(detail::CholeskyAnalysis(lower, layout), lower, {});
  VectorX load = VectorX::Zero(lower.rows()), u(lower.rows());
  for (Index i = 0; i < load.size(); i += 5) load[i] = 0.01;
  solver.solve_into(load, u);
  return {u.cwiseAbs().maxCoeff(), 0.5 * load.dot(u)};
}

/// Length of the last of a thousand rendered forces; -1 when the gate outputs a force that it must not.
double rendered() {
  const ForceLimits limits;
  ForceGate gate(limits);
  Vector3 last = Vector3::Zero();
  for (int k = 1; k <= 1000; ++k) {
    const double now = 1e-3 * k;
    const bool bad = k % 100 == 50;
    const Vector3 wanted =
        bad ? Vector3(std::numeric_limits<double>::quiet_NaN(), 0.0, 1.0) : Vector3(0.3, 0.1, 0.02 * k);
    last = gate.apply(wanted, now, now, true, false).force();
    if (!last.allFinite() || last.norm() > limits.peak_force * (1.0 + 1e-12) || (bad && !last.isZero(0.0))) return -1.0;
  }
  return last.norm();
}

}  // namespace

int main(int argc, char** argv) {
  const auto [largest, energy] = statics();
  const std::array numbers{largest, energy, rendered()};
  bool same = numbers[2] >= 0.0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    std::printf("%.17g ", numbers[i]);
    if (const int at = static_cast<int>(i) + 1; at < argc)
      same = same && std::abs(numbers[i] - std::atof(argv[at])) <= 1e-11 * std::abs(numbers[i]);
  }
  return same ? 0 : 1;
}
