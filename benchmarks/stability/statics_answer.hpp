// Solves a static problem with a HapticFEModel, as a user would.
#pragma once

#include "statics.hpp"

#include <palpate/model/haptic_fe_model.hpp>

#include <numeric>

namespace maps {

template <class Policy>
Answer answer_of(const StaticProblem& problem) {
  Answer answer;
  Scene scene;
  if (!problem.constrained.empty()) scene.fix(problem.constrained);
  scene.touch(problem.touched).point_load(problem.pulled, problem.force);
  RegionMaterials<LinearElastic> materials;
  for (std::size_t r = 0; r < problem.mesh.region_names.size(); ++r)
    materials.emplace_back(problem.mesh.region_names[r], problem.materials[r]);
  SetupOptions options;
  options.columns = ColumnFill::synchronous;  // all columns are read at once
  try {
    HapticFEModel<Tet4, LinearElastic, Policy> model(problem.mesh, scene, materials, options);
    answer.displacement = model.displacement();
    answer.estimate = model.report().probe_error;
    answer.quality = model.report().worst_quality;
    answer.flagged = model.report().has(SetupFlag::ill_conditioned);
    for (const auto& [flag, remark] : model.report().remarks) answer.why += (answer.why.empty() ? "" : "; ") + remark;
    std::vector<int> vertices(problem.touched.size());
    std::iota(vertices.begin(), vertices.end(), 0);
    if (!model.require_columns(vertices).ok()) {
      answer.flagged = true;
      answer.why += "; columns missing";
      return answer;
    }
    const Index dofs = 3 * static_cast<Index>(vertices.size());
    answer.compliance = MatrixX::Zero(dofs, dofs);
    const auto touched = [&](int v) {  // vertices have the order of the surface
      const auto at = std::ranges::find(problem.touched, model.touchable_nodes()[static_cast<std::size_t>(v)]);
      return 3 * static_cast<Index>(at - problem.touched.begin());
    };
    for (int i : vertices)
      for (int j : vertices)
        answer.compliance.template block<3, 3>(touched(i), touched(j)) = model.compliance(i, j).template cast<double>();
  } catch (const SetupError& error) {
    answer.refused = true;
    answer.why = std::string(to_string(error.kind()));
  }
  return answer;
}

}  // namespace maps
