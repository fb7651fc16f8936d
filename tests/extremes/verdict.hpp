#pragma once

#include "model/any_model.hpp"
#include "model/reference.hpp"

namespace test {

inline constexpr std::array extreme_policies{PolicyName::sparse_cholesky, PolicyName::conjugate_gradient,
                                             PolicyName::condensed_inverse, PolicyName::condensed_float,
                                             PolicyName::condensed_conjugate_gradient};

/// Outcome of a model with extreme input. The only forbidden outcome is a wrong result without a flag.
enum class Verdict { right, flagged, refused, wrong };

inline const char* name(Verdict v) {
  constexpr std::array names{"right", "flagged", "refused", "WRONG"};
  return names[static_cast<std::size_t>(v)];
}

struct Outcome {
  Verdict verdict = Verdict::refused;
  double error = 0.0;  ///< of displacement and contact compliance, relative, against long double
  double probe = 0.0;  ///< probe error in the model's report
  std::string why;     ///< message of a refusal
};

/// Without the flag IllConditioned the result must be accurate to five digits; with it, the error must be within two
/// digits of the probe error in the report.
inline constexpr double silent_error = 1e-5;

inline Outcome judge(PolicyName policy, const Mesh<Tet4>& mesh, const std::vector<LinearElastic>& materials,
                     const Scene& scene) {
  Outcome outcome;
  Materials named;
  for (std::size_t r = 0; r < mesh.region_names.size(); ++r)
    named.emplace_back(mesh.region_names[r], materials[std::min(r, materials.size() - 1)]);
  std::unique_ptr<AnyModel> model;
  try {
    model = make_model(policy, mesh, scene, named);
  } catch (const SetupError& error) {
    outcome.why = error.what();
    return outcome;
  }
  const Reference truth(mesh, materials, scene);
  outcome.probe = model->report().probe_error;
  outcome.error = truth.displacement.isZero(0.0) ? model->displacement().norm()
                                                 : relative(model->displacement(), truth.displacement);
  const auto vertices = all_vertices(model->contact_surface().vertex_count());
  const bool complete = model->require_columns(vertices).ok();
  double difference = 0.0, scale = 0.0;
  for (int i : vertices)
    for (int j : vertices) {
      const auto node = [&](int v) { return model->touchable_nodes()[static_cast<std::size_t>(v)]; };
      const Matrix3 c = truth.compliance(node(i), node(j));
      difference = std::max(difference, largest(model->compliance(i, j) - c));
      scale = std::max(scale, largest(c));
    }
  if (scale > 0.0 && complete) outcome.error = std::max(outcome.error, difference / scale);
  const bool flag = model->report().has(SetupFlag::ill_conditioned) || !complete;
  const double bound = std::max(silent_error, flag ? 100.0 * outcome.probe : 0.0);
  outcome.verdict = !truth.definite || !(outcome.error <= bound) ? Verdict::wrong
                    : flag                                       ? Verdict::flagged
                                                                 : Verdict::right;
  return outcome;
}

/// Judges all policies; none may be wrong. `expect` is called with each outcome.
template <class Expect>
void judge_all(const std::string& what, const Mesh<Tet4>& mesh, const std::vector<LinearElastic>& materials,
               const Scene& scene, Expect expect) {
  for (PolicyName policy : extreme_policies) {
    const Outcome o = judge(policy, mesh, materials, scene);
    INFO(what << ", " << name(policy) << ": " << name(o.verdict) << ", error " << o.error << ", probe " << o.probe
              << ' ' << o.why);
    CHECK(o.verdict != Verdict::wrong);
    expect(policy, o);
  }
}

}  // namespace test
