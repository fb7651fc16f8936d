// Definitions of refine_to_accuracy.hpp.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/mesh/refine_near.hpp>
#include <palpate/model/static/refine_to_accuracy.hpp>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE AccuracySearch::AccuracySearch(const Mesh<Tet4>& mesh, const Scene& scene, const AccuracyGoal& goal)
    : goal_(goal), given_(mesh) {
  constexpr double edge_at_five_percent = 0.28, order = 1.75;
  if (!(goal.error >= 1e-3 && goal.error <= 1.0))
    raise(SetupErrorKind::bad_argument, "the wanted error of forces is " + number(goal.error),
          "It is relative: 0.05 for 5 %; 0.001 to 1");
  if (!(goal.most_seconds > 0.0) || goal.most_nodes < mesh.node_count())
    raise(SetupErrorKind::bad_argument,
          "the budget for accurate forces is " + number(goal.most_seconds) + " s and " +
              std::to_string(goal.most_nodes) + " nodes, the mesh has " + std::to_string(mesh.node_count()),
          "Allow more");
  if (!(scene.touch_radius() > 0.0))
    raise(SetupErrorKind::bad_argument, "the scene does not give the radius of the tool",
          "touch(where, {.radius = ...})");
  report_.wanted = goal.error;
  report_.nodes_as_given = mesh.node_count();
  scene_ = name_listed_nodes(given_, scene);
  make_mesh(edge_at_five_percent * scene.touch_radius() * std::pow(goal.error / 0.05, 1.0 / order));
}

PALPATE_INLINE std::optional<MeshRef> AccuracySearch::coarse() const {
  if (given_.has_fibres()) return std::nullopt;
  return mesh_ref(given_);
}

/// False when the number of nodes does not allow a mesh that is clearly finer than the present one.
PALPATE_INLINE bool AccuracySearch::make_mesh(double edge) {
  constexpr double coarser = 1.15, least_change = 0.95;
  RefineNearReport done;
  for (;; edge *= coarser) {
    if (edge_ > 0.0 && edge > least_change * edge_) return false;
    Mesh<Tet4> finer = refine_near_touched(given_, scene_, edge, {.most_nodes = goal_.most_nodes}, &done);
    if (!done.most_nodes_reached) {
      mesh_ = std::move(finer);
      edge_ = edge;
      return true;
    }
    is_full_ = true;
  }
}

/// By the order of convergence between the last two meshes, or the order that is expected.
PALPATE_INLINE double AccuracySearch::next_edge() const {
  constexpr double aim = 0.85, expected_order = 2.0, least_order = 1.0, greatest_order = 3.0, least_part = 0.3;
  const std::vector<AccuracyStep>& steps = report_.steps;
  const AccuracyStep& last = steps.back();
  double order = expected_order;
  if (steps.size() > 1) {
    const AccuracyStep& before = steps[steps.size() - 2];
    order = std::log(before.error / last.error) / std::log(before.edge / last.edge);
    order = std::isfinite(order) ? std::clamp(order, least_order, greatest_order) : least_order;
  }
  return last.edge * std::max(least_part, std::pow(aim * goal_.error / last.error, 1.0 / order));
}

PALPATE_INLINE bool AccuracySearch::end(std::string why_not) {
  report_.why_not = std::move(why_not);
  return false;
}

PALPATE_INLINE bool AccuracySearch::refine(const AccuracyReport& measured, double seconds) {
  constexpr std::size_t most_meshes = 4;
  constexpr double longer = 2.0;  // set-up of a finer mesh
  report_.steps.push_back({edge_, mesh_.node_count(), measured.typical, measured.largest, seconds});
  if (measured.places == 0) return end("the error could not be measured: " + measured.remark);
  if (measured.typical <= goal_.error) return end({});
  double spent = 0.0;
  for (const AccuracyStep& step : report_.steps) spent += step.seconds;
  const std::string too_many = "a finer mesh has more than " + std::to_string(goal_.most_nodes) + " nodes";
  if (is_full_) return end(too_many);
  if (spent + longer * seconds > goal_.most_seconds)
    return end("the set-up on a finer mesh would end after " + number(goal_.most_seconds) + " s");
  if (report_.steps.size() == most_meshes) return end("the error does not fall as expected");
  return make_mesh(next_edge()) || end(too_many);
}

PALPATE_INLINE std::ostream& operator<<(std::ostream& out, const AccuracySearchReport& r) {
  const auto rounded = [](double x, double digits = 10.0) { return number(std::round(x * digits) / digits); };
  out << "force error wanted: " << rounded(100.0 * r.wanted) << " %; mesh as given: " << r.nodes_as_given << " nodes\n";
  for (const AccuracyStep& s : r.steps)
    out << "  edges of " << rounded(1e3 * s.edge, 100.0) + " mm: " << s.nodes << " nodes, error "
        << rounded(100.0 * s.error) << " %, at most " << rounded(100.0 * s.largest) << " %, set-up "
        << rounded(s.seconds) << " s\n";
  if (!r.reached()) out << "  not reached: " << r.why_not << '\n';
  return out;
}

}}  // namespace palpate
