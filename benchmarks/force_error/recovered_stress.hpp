// The estimate of Zienkiewicz and Zhu for the error of a contact force, beside the measured one.
#pragma once

#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/post/error_estimate.hpp>

#include <vector>

namespace force_error {

/// Excess of the contact force of the last tick over that on a fine mesh [N], from the stress under its contact forces
/// f alone. u_h is the solution for f, e its error. Because K u_h = f on the mesh, f^T (W - W_h) f = |e|^2 (energy
/// norm), and the recovered stress estimates |e|. So |e|^2 / F is the missing depth of a force F, without
/// ContactParameters::subfacet_compliance; it becomes a force as in ForceAccuracy. Valid for elements that are
/// integrated exactly and compatible: not for smoothed strain, mean dilatation. It does not see the shape of the facets
/// and the spacing of contact points. One solve and one recovery of stress: milliseconds.
template <class Model>
double recovery_estimate(Model& model, const palpate::HapticServo& servo) {
  std::vector<palpate::VertexForce> forces;
  for (const palpate::ToolContact& contact : servo.contacts())
    for (std::size_t a = 0; a < 3; ++a)
      if (contact.weights[a] > 0.0)
        forces.push_back(
            {contact.vertices[a], palpate::ModelVector(-contact.weights[a] * contact.force * contact.normal)});
  const double force = servo.contact_force().norm(), depth = servo.indentation();
  if (forces.empty() || !(depth > 0.0)) return 0.0;
  const palpate::ErrorEstimate estimate = palpate::estimate_error(model.body(), model.displacement(forces));
  const double missing = estimate.error * estimate.error / force;
  return force * missing / (depth + missing);
}

}  // namespace force_error
