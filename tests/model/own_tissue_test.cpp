// A solver whose traits name a tissue of its own.
#include <palpate/contact/tools.hpp>
#include <palpate/cut/cuttable_moving.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/model/moving/quasi_newton.hpp>
#include <palpate/model/static/stiffening.hpp>
#include <palpate/own_types.hpp>

#include <concepts>
#include <cstdint>

#include "catch.hpp"

using namespace palpate;

namespace {

struct SofterParameters {
  double factor = 2.0;
};

/// Linear tissue whose compliance is multiplied.
template <class E, class M>
class SofterTissue : public StaticTissue<E, M, SparseCholesky> {
  using Linear = StaticTissue<E, M, SparseCholesky>;

 public:
  using Parameters = SofterParameters;

  Matrix3 compliance(int i, int j) const noexcept { return factor_ * Linear::compliance(i, j); }
  std::uint64_t compliance_revision() const noexcept { return Linear::compliance_revision(); }
  double compliance_bound(int j) const noexcept { return factor_ * Linear::compliance_bound(j); }
  double compliance_floor() const noexcept { return factor_ * Linear::compliance_floor(); }

 protected:
  template <MeshOf<E> Given>
  SofterTissue(const Given& mesh, const Scene& scene, const RegionMaterials<M>& materials, const SetupOptions& options,
               const Parameters& parameters)
      : Linear(mesh, scene, materials, options), factor_(parameters.factor) {}

 private:
  double factor_;
};

struct Softer {};
/// Its traits name a tissue of another form.
struct Misfit {};

}  // namespace

template <>
struct palpate::SolverTraits<Softer> {
  template <class E, class M>
  using Tissue = SofterTissue<E, M>;
};
template <>
struct palpate::SolverTraits<Misfit> : palpate::SolverTraits<SparseCholesky> {
  template <class E>
  using Tissue = SofterTissue<E, LinearElastic>;
};

namespace {

using Own = HapticFEModel<Tet4, LinearElastic, Softer>;
using Linear = HapticFEModel<Tet4, LinearElastic, SparseCholesky>;
static_assert(TissueModel<Own>);
static_assert(std::same_as<Own::Parameters, SofterParameters>);
static_assert(std::same_as<Linear::Parameters, NoParameters>);
// An error where it is used, not ignored
static_assert(detail::NamesTissue<Softer> && detail::NamesTissue<Misfit>);
static_assert(!detail::NamesTissue<SparseCholesky> && !detail::NamesTissue<Implicit<QuasiNewton<>>>);
// Every family of solvers by the same template
static_assert(std::derived_from<Linear, LinearTissue<double>>);
static_assert(std::derived_from<HapticFEModel<Tet4, LinearElastic, Stiffening<SparseCholesky>>, LinearTissue<double>>);
static_assert(std::derived_from<HapticFEModel<Tet4, NeoHookean, Implicit<QuasiNewton<>>>, MovingTissue>);
static_assert(
    std::derived_from<HapticFEModel<Tet4, LinearElastic, Cuttable<Condensed<SelectiveInverse>>>, CuttableTissue<Tet4>>);
static_assert(
    std::derived_from<HapticFEModel<Tet4, NeoHookean, Cuttable<Implicit<QuasiNewton<>>>>, CuttableMovingTissue<Tet4>>);

const Scene scene = Scene().fix("z0").touch("z1");
const LinearElastic material{5e3, 0.4, 1000.0};

/// Force [N] of a sphere pressed 1 mm into the middle of the upper face.
template <class Model>
double press(Model& model) {
  HapticServo servo(model, SphereTool{.radius = 0.005}, {.coupling_stiffness = infinity});
  for (int tick = 0; tick < 50; ++tick) servo.tick({.position = Vector3(0.02, 0.02, 0.024)});
  return servo.tick_view().contact_force().norm();
}

}  // namespace

TEST_CASE("a model derives from the tissue that the traits of its solver name, and passes its parameters",
          "[model][own_tissue]") {
  const Mesh<Tet4> mesh = box_tet4({0.04, 0.04, 0.02}, {8, 8, 4});
  const SetupOptions exact{.columns = ColumnFill::synchronous};
  Own same(mesh, scene, material, exact, {.factor = 1.0}), softer(mesh, scene, material, exact);
  const double force = press(same);
  REQUIRE(force > 0.01);
  CHECK(press(softer) == Catch::Approx(0.5 * force).epsilon(1e-6));
  CHECK(same.mesh().node_count() == mesh.node_count());
  CHECK(&same.body().mesh == &same.mesh());
}
