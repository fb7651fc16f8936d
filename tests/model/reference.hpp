#pragma once

#include <palpate/assembly/essential_conditions.hpp>
#include <palpate/assembly/load_vector.hpp>

#include "assembly/bodies.hpp"
#include "local/closed_form.hpp"

#include <numeric>

namespace test {

/// Statics of a small body in long double: stiffness by closed form, dense Cholesky, no condensation.
class Reference {
 public:
  using Real = long double;

  Reference(const Mesh<Tet4>& mesh, const std::vector<LinearElastic>& materials, const Scene& scene)
      : body_(body_of(mesh, materials)),
        boundary_(extract_boundary<Tet4>(body_.mesh)),
        conditions_(resolve_essential(body_.mesh, boundary_, scene)),
        k_(closed_form_stiffness<Real>(body_.mesh, by_region(materials))) {
    const Index n = conditions_.free_count();
    DenseMatrix<Real> free(n, n);
    for (Index i = 0; i < n; ++i)
      for (Index j = 0; j < n; ++j) free(i, j) = k_(dof(i), dof(j));
    const Eigen::LLT<DenseMatrix<Real>> llt(free);
    definite = llt.info() == Eigen::Success;
    inverse_ = llt.solve(DenseMatrix<Real>::Identity(n, n));
    set_scene(scene, scene.gravity());
  }

  /// Sets loads and prescribed values; gravity is in the body frame.
  void set_scene(const Scene& scene, const Vector3& gravity) {
    conditions_.prescribed = resolve_essential(body_.mesh, boundary_, scene).prescribed;
    body_.initial_strain = detail::initial_strains_by_region(body_.mesh, scene);
    VectorX f = detail::applied_load(body_, boundary_, scene) + detail::initial_strain_load(body_);
    const VectorX mass = nodal_mass(body_);
    for (Index i = 0; i < mass.size(); ++i) f.segment<3>(3 * i) += mass[i] * gravity;
    load = f;
    const DenseVector<Real> rest = f.cast<Real>() - k_ * conditions_.prescribed.cast<Real>();
    DenseVector<Real> part(conditions_.free_count());
    for (Index i = 0; i < part.size(); ++i) part[i] = rest[dof(i)];
    const DenseVector<Real> answer = inverse_ * part;
    displacement = conditions_.prescribed;
    for (Index i = 0; i < part.size(); ++i) displacement[dof(i)] = static_cast<double>(answer[i]);
  }

  /// Displacement of node i per force on node j.
  Matrix3 compliance(NodeId i, NodeId j) const {
    Matrix3 c = Matrix3::Zero();
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) {
        const Index p = conditions_.free_index[static_cast<std::size_t>(3 * i + a)];
        const Index q = conditions_.free_index[static_cast<std::size_t>(3 * j + b)];
        if (p >= 0 && q >= 0) c(a, b) = static_cast<double>(inverse_(p, q));
      }
    return c;
  }

  VectorX displacement;  ///< 3 per node [m]
  VectorX load;          ///< on all nodes, initial strain included [N]
  bool definite = false;

 private:
  Index dof(Index free) const { return conditions_.free_dofs[static_cast<std::size_t>(free)]; }
  std::vector<LinearElastic> by_region(const std::vector<LinearElastic>& materials) const {
    std::vector<LinearElastic> all;
    for (std::size_t r = 0; r < body_.mesh.region_names.size(); ++r)
      all.push_back(materials[std::min(r, materials.size() - 1)]);
    return all;
  }

  Body<Tet4> body_;
  std::vector<BoundaryFace> boundary_;
  EssentialConditions conditions_;
  DenseMatrix<Real> k_, inverse_;
};

/// |a - b| / |b|.
inline double relative(const VectorX& a, const VectorX& b) {
  return (a - b).norm() / b.norm();
}

/// A small brick of tissue, 10 cm long, fixed at x = 0, touchable on top; nodes inside and below are condensed.
inline Mesh<Tet4> brick() {
  return box_tet4({0.1, 0.06, 0.04}, {3, 2, 2});
}
inline Scene brick_scene() {
  return Scene().fix("x0").touch("z1").render("surface");
}

/// Loads of every kind, on touchable and on condensed nodes.
inline Scene loaded(Scene scene) {
  Vector6 strain;
  strain << 1e-3, -2e-3, 5e-4, 3e-4, -1e-4, 2e-4;
  return scene.gravity({1.0, -2.0, -9.81})
      .traction("x1", {5.0, 2.0, -10.0})
      .pressure("y1", 20.0)
      .point_load("z1", {0.1, 0.0, -0.05})
      .body_load(everywhere, {0.0, 300.0, 0.0})
      .initial_strain(everywhere, strain)
      .prescribe(std::vector<NodeId>{3}, {1e-3, std::nullopt, std::nullopt});
}

/// The numbers from 0 to n - 1.
inline std::vector<int> all_vertices(int n) {
  std::vector<int> v(static_cast<std::size_t>(n));
  std::iota(v.begin(), v.end(), 0);
  return v;
}

}  // namespace test
