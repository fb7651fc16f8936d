// The error of a contact force from what was measured at set-up.
#include <palpate/contact/force_accuracy.hpp>

#include "catch.hpp"

#include <cmath>

using namespace palpate;

namespace {

/// One place with missing depths of 1, 2 and 3 mm at 1 N over a vertex, an edge and a facet.
detail::MissingDepth three_depths(double length) {
  detail::MissingDepth place;
  for (std::size_t p = 0; p < detail::MissingDepth::positions; ++p)
    place.levels[p] = {{1.0, 1e-3 * static_cast<double>(p + 1), 1e-4}, {2.0, 3e-3 * static_cast<double>(p + 1), 1e-4}};
  place.unseen = {0.0, 0.01, 0.03};
  place.facet_length = length;
  return place;
}

ContactTool sphere_with_force(double radius, double force) {
  ContactTool tool;
  tool.radius = radius;
  tool.force = {0.0, 0.0, force};
  tool.active = true;
  return tool;
}

Contact contact_at(const Triangle& vertices, const std::array<double, 3>& weights, double force) {
  Contact c;
  c.vertices = vertices;
  c.weights = weights;
  c.force = force;
  return c;
}

const ForceAccuracy& accuracy_of_one_place() {
  static const ForceAccuracy accuracy(0.01, {three_depths(5e-3)},
                                      std::vector<ForceAccuracy::Vertex>(4, {0, 5e-3, 1.0}));
  return accuracy;
}

}  // namespace

TEST_CASE("missing depths are interpolated from zero, and beyond the last level only their doubt grows",
          "[force_error]") {
  const detail::MissingDepth place = three_depths(5e-3);
  CHECK(place.at(0, 0.0).missing == 0.0);
  CHECK_THAT(place.at(0, 0.5).missing, Catch::Matchers::WithinRel(0.5e-3, 1e-12));
  CHECK_THAT(place.at(0, 1.5).missing, Catch::Matchers::WithinRel(2e-3, 1e-12));
  CHECK_THAT(place.at(2, 4.0).missing, Catch::Matchers::WithinRel(9e-3, 1e-12));
  CHECK_THAT(place.at(2, 4.0).doubt,
             Catch::Matchers::WithinRel(2e-4 + 9e-3, 1e-12));  // contains what is proportional to the force
  CHECK_THAT(place.at(1, 0.5).doubt, Catch::Matchers::WithinRel(0.5e-4, 1e-12));
  CHECK(std::isinf(detail::MissingDepth{}.at(0, 1.0).doubt));  // nothing is known
}

TEST_CASE("the position over a facet follows from the loads of the vertices", "[force_error]") {
  const double depth = 0.01, force = 1.0;
  const ContactTool tool = sphere_with_force(0.01, force);
  const auto expected_of = [&](std::vector<Contact> contacts) {
    return accuracy_of_one_place().error(tool, 0, contacts, depth).expected;
  };
  // The same contact radius and facet length as at the place: F' = F / (1 + missing / depth).
  const auto excess = [&](double missing) { return force * (missing / depth) / (1.0 + missing / depth); };
  CHECK(expected_of({contact_at({0, 1, 2}, {1.0, 0.0, 0.0}, 1.0)}) == Catch::Approx(excess(1e-3)));
  CHECK(expected_of({contact_at({0, 1, 2}, {1.0, 0.0, 0.0}, 0.5), contact_at({1, 2, 3}, {1.0, 0.0, 0.0}, 0.5)}) ==
        Catch::Approx(excess(2e-3)));
  CHECK(expected_of({contact_at({0, 1, 2}, {1.0 / 3, 1.0 / 3, 1.0 / 3}, 1.0)}) == Catch::Approx(excess(3e-3)));
  // Halfway between a vertex and the middle of an edge.
  CHECK(expected_of({contact_at({0, 1, 2}, {0.75, 0.25, 0.0}, 1.0)}) == Catch::Approx(excess(1.5e-3)));
  // Contacts of other tools do not count.
  Contact other = contact_at({0, 1, 2}, {0.0, 1.0, 0.0}, 5.0);
  other.tool = 1;
  CHECK(expected_of({contact_at({0, 1, 2}, {1.0, 0.0, 0.0}, 1.0), other}) == Catch::Approx(excess(1e-3)));
}

TEST_CASE("the bound contains the expected error, and is infinite for a sphere that was not measured",
          "[force_error]") {
  const std::vector<Contact> contacts{contact_at({0, 1, 2}, {1.0, 0.0, 0.0}, 1.0)};
  const ForceAccuracy& accuracy = accuracy_of_one_place();
  const ForceError error = accuracy.error(sphere_with_force(0.01, 1.0), 0, contacts, 0.01);
  CHECK(error.bound > error.expected);
  CHECK(std::isfinite(error.bound));
  CHECK(std::isinf(accuracy.error(sphere_with_force(0.02, 1.0), 0, contacts, 0.01).bound));
  CHECK(std::isinf(accuracy.error(sphere_with_force(0.005, 1.0), 0, contacts, 0.01).bound));
  CHECK(std::isinf(accuracy.error(sphere_with_force(0.01, 1.0), 0, {}, 0.01).bound));
  ContactTool capsule = sphere_with_force(0.01, 1.0);
  capsule.half_length = 0.02;
  CHECK(std::isinf(accuracy.error(capsule, 0, contacts, 0.01).bound));
  CHECK(accuracy.error_without_force(2).bound == Catch::Approx(0.03));
}

TEST_CASE("the missing depth follows length and modulus of the facets, less the indentation that is added already",
          "[force_error]") {
  const ForceAccuracy accuracy(0.01, {three_depths(5e-3)}, {{0, 5e-3, 1.0}, {0, 10e-3, 1.0}, {0, 5e-3, 0.5}});
  ContactTool tool = sphere_with_force(0.01, 1.0);
  const auto relative = [&](int vertex) {
    const std::vector<Contact> contacts{contact_at({vertex, 0, 0}, {1.0, 0.0, 0.0}, 1.0)};
    const double expected = accuracy.error(tool, 0, contacts, 0.01).expected;
    return expected / (1.0 - expected);
  };
  CHECK(relative(0) == Catch::Approx(0.1));
  CHECK(relative(1) > 1.5 * relative(0));
  CHECK(relative(1) < 4.0 * relative(0));  // second order at most
  CHECK(relative(2) == Catch::Approx(0.05));
  tool.force.z() = 3.0;  // as deep as 1.5 N at the place, which is between its levels
  const ForceError stiff = accuracy.error(tool, 0, std::vector{contact_at({2, 0, 0}, {1.0, 0.0, 0.0}, 3.0)}, 0.01);
  CHECK_THAT(stiff.expected, Catch::Matchers::WithinRel(3.0 * 0.2 / 1.2, 1e-12));
  tool.force.z() = 1.0;
  ForceAccuracy unseen(0.01, {three_depths(5e-3)}, {{0, 5e-3, 0.5}});
  CHECK_THAT(unseen.error_without_force(0).bound,
             Catch::Matchers::WithinRel(0.06, 1e-12));  // a force is proportional to the modulus
}
