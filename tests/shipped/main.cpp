// Every composition in palpate::compiled, used by a program that instantiates no template itself: each is constructed,
// gives the same displacement as the first composition of its element, and has all its members.
#include <palpate/palpate.hpp>

#include <palpate/assembly/body.hpp>
#include <palpate/elements.hpp>
#include <palpate/material/orthotropic.hpp>

#include <cstdio>
#include <typeinfo>

using namespace palpate;

namespace {

int failures = 0;

Scene scene() {
  Scene s;
  s.fix("z0").touch("z1").render("surface").gravity({1.0, 2.0, -9.81});
  return s;
}

/// Displacement of a model; also checks the members that are templates.
template <class Model, class Given, class Material>
VectorX displacement(const Given& mesh, const Material& material) {
  const Model model(mesh, scene(), material);
  const Model by_region(mesh, scene(), RegionMaterials<Material>{{std::string(everywhere), material}});
  if (model.displacement() != by_region.displacement()) {
    std::printf("%s: one material everywhere and one per region give different displacements\n", typeid(Model).name());
    ++failures;
  }
  if (model.mesh().node_count() != mesh.node_count() || model.body().mesh.element_count() != mesh.element_count() ||
      model.boundary().empty()) {
    std::printf("%s: mesh, body or boundary differs from the input mesh\n", typeid(Model).name());
    ++failures;
  }
  return model.displacement();
}

template <class Model, class Given, class Material>
void compare(const Given& mesh, const Material& material, const VectorX& expected, double tolerance) {
  const double error = (displacement<Model>(mesh, material) - expected).norm() / expected.norm();
  if (error <= tolerance) return;
  std::printf("%s: relative error of the displacement %g\n", typeid(Model).name(), error);
  ++failures;
}

template <Element E, class Given>
void element(const Given& mesh) {
  const LinearElastic liver{.youngs_modulus = 5e3, .poisson_ratio = 0.45, .density = 1060.0};
  const VectorX u = displacement<HapticFEModel<E, LinearElastic>>(mesh, liver);
  compare<HapticFEModel<E, LinearElastic, Condensed<SelectiveInverseFloat>>>(mesh, liver, u, 1e-6);
  compare<HapticFEModel<E, LinearElastic, Condensed<DenseCholesky>>>(mesh, liver, u, 1e-10);
  compare<HapticFEModel<E, LinearElastic, Condensed<ConjugateGradient>>>(mesh, liver, u, 1e-10);
  compare<HapticFEModel<E, LinearElastic, SparseCholesky>>(mesh, liver, u, 1e-10);
  compare<HapticFEModel<E, LinearElastic, SelectiveInverse>>(mesh, liver, u, 1e-10);
  compare<HapticFEModel<E, LinearElastic, ConjugateGradient>>(mesh, liver, u, 1e-7);
  compare<HapticFEModel<E, LinearElastic, WithAssembly<ConjugateGradient, MatrixFree>>>(mesh, liver, u, 1e-7);

  const double shear = liver.youngs_modulus / (2.0 * (1.0 + liver.poisson_ratio));
  TransverselyIsotropic fibres;
  fibres.youngs_modulus_along = fibres.youngs_modulus_across = liver.youngs_modulus;
  fibres.poisson_ratio_along = fibres.poisson_ratio_across = liver.poisson_ratio;
  fibres.shear_modulus_along = shear;
  fibres.density = liver.density;
  compare<HapticFEModel<E, TransverselyIsotropic>>(mesh, fibres, u, 1e-9);
  Orthotropic orthotropic;
  orthotropic.youngs_modulus_1 = orthotropic.youngs_modulus_2 = orthotropic.youngs_modulus_3 = liver.youngs_modulus;
  orthotropic.poisson_ratio_12 = orthotropic.poisson_ratio_13 = orthotropic.poisson_ratio_23 = liver.poisson_ratio;
  orthotropic.shear_modulus_12 = orthotropic.shear_modulus_13 = orthotropic.shear_modulus_23 = shear;
  orthotropic.density = liver.density;
  compare<HapticFEModel<E, Orthotropic>>(mesh, orthotropic, u, 1e-9);
}

}  // namespace

int main() {
  const Vector3 size(0.03, 0.02, 0.02);
  element<Tet4>(box_tet4(size, {3, 2, 2}));
  element<Smoothed<Tet4>>(box_tet4(size, {3, 2, 2}));
  element<Tet10>(box_tet10(size, {2, 2, 1}));
  element<Hex8>(box_hex8(size, {3, 2, 2}));
  element<MeanDilatation<Hex8>>(box_hex8(size, {3, 2, 2}));
  element<Hex20>(box_hex20(size, {2, 2, 1}));
  if (failures == 0) std::printf("all shipped compositions give the expected displacement\n");
  return failures;
}
