// Metamorphic tests: relations between the solutions of modified problems; no reference solution is needed.
#include <palpate/linear/condition.hpp>
#include <palpate/testing/tissue_laws.hpp>

#include "model/any_model.hpp"
#include "model/reference.hpp"

#include <numeric>

using namespace test;

namespace {

constexpr std::array direct{PolicyName::sparse_cholesky, PolicyName::condensed_inverse};

/// Conditions that do not depend on a frame: everything at x = 0 constrained, a load with a given direction.
Scene hanging(const Vector3& gravity) {
  return brick_scene().gravity(gravity).point_load("z1", 0.02 * gravity);
}

MatrixX dense_stiffness(const Mesh<Tet4>& mesh, const LinearElastic& m = liver) {
  const Body<Tet4> body = body_of(mesh, {m});
  const BlockMatrix k = assemble_stiffness<Tet4>(body, {});
  MatrixX dense(k.size(), k.size());
  VectorX column(k.size());
  for (Index j = 0; j < k.size(); ++j) {
    k.apply(VectorX::Unit(k.size(), j), column);
    dense.col(j) = column;
  }
  return dense;
}

Mesh<Tet4> moved(Mesh<Tet4> mesh, const Matrix3& linear, const Vector3& shift) {
  for (Vector3& x : mesh.positions) x = linear * x + shift;
  return mesh;
}

/// Every node's vector rotated, mirrored or scaled.
VectorX mapped(const VectorX& u, const Matrix3& linear) {
  VectorX v(u.size());
  for (Index i = 0; i < u.size() / 3; ++i) v.segment<3>(3 * i) = linear * u.segment<3>(3 * i);
  return v;
}

/// Compliance between all vertices, requested first.
MatrixX all_compliance(AnyModel& model) {
  const auto vertices = all_vertices(model.contact_surface().vertex_count());
  CHECK(model.require_columns(vertices).ok());
  return testing::compliance_matrix(model, vertices);
}

MatrixX mapped(const MatrixX& c, const Matrix3& linear) {
  MatrixX r = c;
  for (Index i = 0; i < c.rows() / 3; ++i)
    for (Index j = 0; j < c.cols() / 3; ++j)
      r.block<3, 3>(3 * i, 3 * j) = linear * c.block<3, 3>(3 * i, 3 * j) * linear.transpose();
  return r;
}

double difference(const MatrixX& a, const MatrixX& b) {
  return largest(a - b) / largest(b);
}

const Vector3 g(1.0, -2.0, -9.81);

/// The brick with coordinates that stay exact under a large translation.
Mesh<Tet4> rounded_brick() {
  Mesh<Tet4> mesh = brick();
  for (Vector3& x : mesh.positions) x = (x * 0x1p24).array().round() * 0x1p-24;
  return mesh;
}

}  // namespace

TEST_CASE("M1: translation", "[property][M1][extreme][B2]") {
  for (double far : {0x1p7, 0x1p17}) {  // a thousand and a million times the size
    const Vector3 shift = far * Vector3(1.0, -0.5, 0.25);
    const Mesh<Tet4> here = rounded_brick(), there = moved(here, Matrix3::Identity(), shift);
    CHECK(difference(dense_stiffness(there), dense_stiffness(here)) <= 1e-12);
    for (PolicyName policy : direct) {
      const auto a = make_model(policy, here, hanging(g), liver), b = make_model(policy, there, hanging(g), liver);
      CHECK(relative(b->displacement(), a->displacement()) <= 1e-12);
      CHECK(difference(all_compliance(*b), all_compliance(*a)) <= 1e-12);
    }
  }
  SECTION("rounded coordinates cause no more than their own rounding error") {
    const Mesh<Tet4> there = moved(brick(), Matrix3::Identity(), Vector3(100.1, -33.3, 77.7));
    const double rounding = 4 * 130.0 * 2.2e-16 / 0.02;  // of an edge of 2 cm
    CHECK(difference(dense_stiffness(there), dense_stiffness(brick())) <= 10 * rounding);
  }
}

TEST_CASE("M2: rotation", "[property][M2]") {
  testing::Random random(41);
  for (int trial = 0; trial < 3; ++trial) {
    const Matrix3 r = testing::random_rotation(random);
    const Mesh<Tet4> rotated = moved(brick(), r, Vector3::Zero());
    CHECK(difference(dense_stiffness(rotated), mapped(dense_stiffness(brick()), r)) <= 1e-13);
    for (PolicyName policy : direct) {
      const auto a = make_model(policy, brick(), hanging(g), liver),
                 b = make_model(policy, rotated, hanging(r * g), liver);
      CHECK(relative(b->displacement(), mapped(a->displacement(), r)) <= 1e-11);
      CHECK(relative(b->reactions(), mapped(a->reactions(), r)) <= 1e-11);
      CHECK(difference(all_compliance(*b), mapped(all_compliance(*a), r)) <= 1e-11);
      CHECK_THAT(b->strain_energy(), Catch::Matchers::WithinRel(a->strain_energy(), 1e-11));
    }
  }
}

TEST_CASE("M3: size", "[property][M3][extreme][B1]") {
  for (double s : {1e-6, 1e-3, 1e3}) {
    INFO(s);
    const Mesh<Tet4> scaled = moved(brick(), s * Matrix3::Identity(), Vector3::Zero());
    CHECK(difference(dense_stiffness(scaled), s * dense_stiffness(brick())) <= 1e-13);
    for (PolicyName policy : direct) {
      const Scene body_force = brick_scene().gravity(g);
      const auto a = make_model(policy, brick(), body_force, liver), b = make_model(policy, scaled, body_force, liver);
      CHECK(relative(b->displacement() / (s * s), a->displacement()) <= 1e-12);
      CHECK(relative(b->reactions() / (s * s * s), a->reactions()) <= 1e-11);
      CHECK(difference(s * all_compliance(*b), all_compliance(*a)) <= 1e-12);
      CHECK(b->report().has(SetupFlag::suspicious_units) == (s > 1.0));
      CHECK_THAT(b->report().condition_estimate, Catch::Matchers::WithinRel(a->report().condition_estimate, 1e-6));
    }
  }
}

TEST_CASE("M4: metres, newtons, pascals or millimetres, newtons, megapascals", "[property][M4][extreme][B1]") {
  const Mesh<Tet4> millimetres = moved(brick(), 1e3 * Matrix3::Identity(), Vector3::Zero());
  const LinearElastic megapascals{liver.youngs_modulus * 1e-6, liver.poisson_ratio, liver.density * 1e-12};
  for (PolicyName policy : direct) {
    const auto a = make_model(policy, brick(), brick_scene().gravity(g).traction("x1", {5, 0, 0}), liver);
    const auto b =
        make_model(policy, millimetres, brick_scene().gravity(1e3 * g).traction("x1", {5e-6, 0, 0}), megapascals);
    CHECK(relative(b->displacement() * 1e-3, a->displacement()) <= 1e-12);
    CHECK(relative(b->reactions(), a->reactions()) <= 1e-11);  // newtons in both
    CHECK(difference(1e-3 * all_compliance(*b), all_compliance(*a)) <= 1e-12);
    CHECK_THAT(b->compliance_floor() * 1e-3, Catch::Matchers::WithinRel(a->compliance_floor(), 1e-9));
  }
}

TEST_CASE("M5: order of nodes, elements and corners", "[property][M5]") {
  const Mesh<Tet4> mesh = brick();
  testing::Random random(43);
  const auto shuffle = [&random](std::size_t n) {
    std::vector<NodeId> order(n);
    std::iota(order.begin(), order.end(), NodeId{0});
    for (std::size_t i = n; i-- > 1;) std::swap(order[i], order[random.bits() % (i + 1)]);
    return order;
  };
  const auto to = shuffle(mesh.positions.size());
  Mesh<Tet4> other = mesh;
  detail::renumber_nodes(other, to);
  const auto order = shuffle(mesh.elements.size());
  auto elements = other.elements;
  for (std::size_t e = 0; e < order.size(); ++e) {
    elements[e] = other.elements[static_cast<std::size_t>(order[e])];
    std::rotate(elements[e].begin(), elements[e].begin() + 1, elements[e].begin() + 3);  // an even permutation
  }
  other.elements = elements;
  for (PolicyName policy : direct) {
    const auto a = make_model(policy, mesh, hanging(g), liver), b = make_model(policy, other, hanging(g), liver);
    VectorX back(a->displacement().size());
    for (std::size_t i = 0; i < to.size(); ++i)
      back.segment<3>(3 * static_cast<Index>(i)) = b->displacement().segment<3>(3 * Index{to[i]});
    CHECK(relative(back, a->displacement()) <= 1e-10);
    const MatrixX ca = all_compliance(*a), cb = all_compliance(*b);
    double worst = 0.0;
    const auto vertex = [&](NodeId node) {
      return std::ranges::find(b->touchable_nodes(), node) - b->touchable_nodes().begin();
    };
    for (std::size_t i = 0; i < a->touchable_nodes().size(); ++i)
      for (std::size_t j = 0; j < a->touchable_nodes().size(); ++j) {
        const Index p = vertex(to[static_cast<std::size_t>(a->touchable_nodes()[i])]);
        const Index q = vertex(to[static_cast<std::size_t>(a->touchable_nodes()[j])]);
        worst = std::max(worst, largest(cb.block<3, 3>(3 * p, 3 * q) -
                                        ca.block<3, 3>(3 * static_cast<Index>(i), 3 * static_cast<Index>(j))));
      }
    CHECK(worst <= 1e-10 * largest(ca));
  }
}

TEST_CASE("M6: stiffness", "[property][M6][extreme][A3]") {
  for (double c : {1e-9, 3.0, 1e9}) {
    const LinearElastic other{c * liver.youngs_modulus, liver.poisson_ratio, liver.density};
    for (PolicyName policy : direct) {
      const auto a = make_model(policy, brick(), hanging(g), liver), b = make_model(policy, brick(), hanging(g), other);
      CHECK(relative(c * b->displacement(), a->displacement()) <= 1e-12);
      CHECK(relative(b->reactions(), a->reactions()) <= 1e-11);
      CHECK(difference(c * all_compliance(*b), all_compliance(*a)) <= 1e-12);
    }
  }
}

TEST_CASE("M7: superposition and reciprocity", "[property][M7]") {
  const Scene one = brick_scene().traction("x1", {5, 2, -10}), other = brick_scene().gravity(g).pressure("y1", 30);
  Scene both = brick_scene().traction("x1", {5, 2, -10}).gravity(g).pressure("y1", 30);
  const VectorX f = Reference(brick(), {liver}, one).load, h = Reference(brick(), {liver}, other).load;
  for (PolicyName policy : direct) {
    const VectorX u = make_model(policy, brick(), one, liver)->displacement();
    const VectorX v = make_model(policy, brick(), other, liver)->displacement();
    CHECK(relative(u + v, make_model(policy, brick(), both, liver)->displacement()) <= 1e-11);
    CHECK_THAT(f.dot(v), Catch::Matchers::WithinRel(h.dot(u), 1e-11));  // Betti
    const MatrixX c = all_compliance(*make_model(policy, brick(), one, liver));
    CHECK(difference(c, c.transpose()) <= 1e-11);
  }
}

TEST_CASE("M8: mirror image", "[property][M8][extreme][B4]") {
  const Matrix3 mirror = Vector3(1, -1, 1).asDiagonal();
  const Mesh<Tet4> other = moved(brick(), mirror, Vector3::Zero());
  SetupOptions mend;
  mend.admission.inverted = Admission::repair;
  for (PolicyName policy : direct) {
    CHECK_REFUSED(SetupErrorKind::inverted_element, make_model(policy, other, hanging(mirror * g), liver));
    const auto a = make_model(policy, brick(), hanging(g), liver),
               b = make_model(policy, other, hanging(mirror * g), liver, mend);
    CHECK(relative(b->displacement(), mapped(a->displacement(), mirror)) <= 1e-12);
    CHECK(difference(all_compliance(*b), mapped(all_compliance(*a), mirror)) <= 1e-12);
    CHECK(b->report().has(SetupFlag::repaired));
    CHECK(difference(dense_stiffness(b->mesh()), mapped(dense_stiffness(brick()), mirror)) <= 1e-13);
    const Vector3 up(0, 0, 1);  // the repaired surface still points outward
    for (int t = 0; t < static_cast<int>(b->contact_surface().triangles().size()); ++t)
      CHECK(b->contact_surface().normal(t).dot(up) > 0.0);
  }
}

TEST_CASE("M9: two bodies in one mesh do not influence each other", "[property][M9][extreme][B7]") {
  const Mesh<Tet4> one = brick();
  Mesh<Tet4> two = one;
  const auto n = static_cast<NodeId>(one.node_count());
  for (const Vector3& x : one.positions) two.positions.push_back(x + Vector3(0.3, 0.0, 0.0));
  for (auto e : one.elements) {
    for (NodeId& i : e) i += n;
    two.elements.push_back(e);
  }
  for (Group& group : two.groups.all()) {
    const auto nodes = group.nodes;
    const auto faces = group.faces;
    for (NodeId i : nodes) group.nodes.push_back(i + n);
    for (auto face : faces) {
      for (NodeId& i : face) i += n;
      group.faces.push_back(face);
    }
  }
  for (PolicyName policy : direct) {
    const Scene scene = brick_scene().gravity(g).traction("x1", {5, 2, -10});
    const auto alone = make_model(policy, one, scene, liver), pair = make_model(policy, two, scene, liver);
    CHECK(pair->report().has(SetupFlag::disconnected));
    CHECK(relative(pair->displacement().head(3 * n), alone->displacement()) <= 1e-12);
    CHECK(relative(pair->displacement().tail(3 * n), alone->displacement()) <= 1e-12);
    const MatrixX c = all_compliance(*alone), cc = all_compliance(*pair);
    CHECK(difference(cc.topLeftCorner(c.rows(), c.cols()), c) <= 1e-12);
    CHECK(largest(cc.topRightCorner(c.rows(), c.cols())) <= 1e-15 * largest(c));
    CHECK_REFUSED(SetupErrorKind::unconstrained,
                  make_model(policy, two, Scene().fix(std::vector<NodeId>{0, 4, 8, 12}).touch("z1"), liver));
  }
}

TEST_CASE("M11: condensed equals full", "[property][M11]") {
  const Mesh<Tet4> sphere = sphere_tet4(0.05, 3);
  std::vector<NodeId> south;
  for (NodeId i = 0; i < sphere.node_count(); ++i)
    if (sphere.position(i)[2] < -0.03) south.push_back(i);
  const Scene scene = Scene().fix(south).touch("surface").gravity(g).pressure("surface", 10.0);
  const auto full = make_model(PolicyName::sparse_cholesky, sphere, scene, liver);
  const auto condensed = make_model(PolicyName::condensed_inverse, sphere, scene, liver);
  CHECK(condensed->report().condensed_dofs > 0);
  CHECK(relative(condensed->displacement(), full->displacement()) <= 1e-12);
  CHECK(difference(all_compliance(*condensed), all_compliance(*full)) <= 1e-11);
}

TEST_CASE("M12: float stays within the error reported by the probe", "[property][M12][extreme][E7]") {
  for (double nu : {0.3, 0.45, 0.49}) {
    const LinearElastic m{5e3, nu, 1060.0};
    const auto d = make_model(PolicyName::condensed_inverse, brick(), hanging(g), m);
    const auto f = make_model(PolicyName::condensed_float, brick(), hanging(g), m);
    INFO("nu " << nu << ", probe " << f->report().probe_error);
    CHECK(f->report().probe_error <= 1e-3);
    CHECK(relative(f->displacement(), d->displacement()) <= 10 * f->report().probe_error);
    CHECK(difference(all_compliance(*f), all_compliance(*d)) <= 10 * f->report().probe_error);
    CHECK((f->report().probe_error <= 1e-6 || f->report().has(SetupFlag::ill_conditioned)));
    CHECK(testing::describe(testing::tissue_laws(*f, all_vertices(12), {1e-5})) == "");
  }
}
