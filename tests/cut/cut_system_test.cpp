#include <palpate/cut/detail/cut_renewal.hpp>
#include <palpate/cut/detail/swept_faces.hpp>
#include <palpate/element/hex8.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/testing/random.hpp>

#include <thread>

#include "catch.hpp"

using namespace palpate;

namespace {

template <class E>
struct CutBlock {
  CutPhysics<E> physics;
  CutTopology<E> topology;
  detail::CutSystem<E> system;

  CutBlock(const Mesh<E>& mesh, const Scene& scene, const std::vector<NodeId>& kept)
      : physics(make_body(mesh, LinearElastic{.youngs_modulus = 5e3, .poisson_ratio = 0.4, .density = 1000.0}),
                extract_boundary<E>(mesh), scene),
        topology(mesh, resolve_essential(mesh, extract_boundary<E>(mesh), scene).constrained),
        system(topology, physics, kept) {}

  /// Cuts, and folds from time to time.
  void cut(const CutOrder& order) {
    const auto change = topology.apply(order);
    fold();
    last = system.update(topology, change);
  }
  void fold() {
    system.fold();
    last.reset();
  }
  bool is_constrained(NodeId node) const {
    const auto& star = topology.elements_at(node);
    return !star.empty() && topology.state(star.front()) == ElementState::supported;
  }

  /// Starts from a new factor when rounding errors have accumulated; returns whether it did.
  bool renew_if_inaccurate() {
    if (!(system.measured_error() > 1e-12)) return false;
    std::vector<NodeId> kept;
    for (NodeId node = 0; node < topology.mesh().node_count(); ++node)
      if (is_constrained(node) && system.index_of(node, 2) >= 0) kept.push_back(node);
    system = detail::CutSystem<E>(topology, physics, kept);
    last.reset();
    return true;
  }

  /// Largest relative difference of compliance and displacement from a new system of the remaining body.
  double error() {
    std::vector<NodeId> kept;
    for (NodeId node = 0; node < topology.mesh().node_count(); ++node)
      if (is_constrained(node) && (system.index_of(node, 0) >= 0 || system.index_of(node, 2) >= 0))
        kept.push_back(node);
    const detail::CutSystem<E> fresh(topology, physics, kept);
    const auto step = last ? last : system.folded_step();
    const auto truth = fresh.folded_step();
    double wrong = 0.0, scale = 0.0;
    for (const NodeId a : kept)
      for (const NodeId b : kept)
        for (int c = 0; c < 3; ++c)
          for (int d = 0; d < 3; ++d) {
            const Index i = system.index_of(a, c), j = system.index_of(b, d);
            REQUIRE((i >= 0) == (fresh.index_of(a, c) >= 0));
            if (i < 0 || j < 0) continue;
            const double exact = (*truth)(fresh.index_of(a, c), fresh.index_of(b, d));
            wrong = std::max(wrong, std::abs((*step)(i, j) - exact));
            scale = std::max(scale, std::abs(exact));
          }
    double moved = 0.0, far = 0.0;
    system.recover();
    for (NodeId node = 0; node < topology.mesh().node_count(); ++node)
      if (is_constrained(node)) {
        const Vector3 exact = fresh.displacement().template segment<3>(3 * Index{node});
        moved = std::max(moved, (system.displacement().template segment<3>(3 * Index{node}) - exact).norm());
        far = std::max(far, exact.norm());
      }
    UNSCOPED_INFO("compliance " << wrong / scale << ", displacement " << moved / far);
    return scale == 0.0 ? 0.0 : std::max(wrong / scale, far > 0.0 ? moved / far : 0.0);
  }
  std::shared_ptr<const detail::CutStep> last;  // until it is folded
};

std::vector<NodeId> top_of(const Mesh<Tet4>& mesh) {
  return mesh.find_group("z1")->nodes;
}
Scene hanging() {
  Vector6 swelling = Vector6::Zero();
  swelling.head<3>().setConstant(0.01);
  return Scene()
      .prescribe("z0", {0.001, 0.0, 0.0})
      .prescribe("x0", {0.001, std::nullopt, std::nullopt})
      .gravity({0.0, 1.0, -9.81})
      .traction("z1", {3.0, 0.0, 5.0})
      .pressure("y1", 2.0)
      .initial_strain(everywhere, swelling);
}

}  // namespace

TEST_CASE("the compliance after removals and slits equals that of a new model", "[cut]") {
  const auto mesh = box_tet4({0.1, 0.08, 0.06}, {5, 4, 3});
  CutBlock<Tet4> b(mesh, hanging(), top_of(mesh));
  const auto rest = [&](NodeId node) { return b.topology.mesh().position(node); };
  const auto change = b.topology.apply({{17, 44, 45}, {}});
  b.last = b.system.update(b.topology, change);
  CHECK(b.error() < 1e-10);  // before it is folded
  b.fold();
  CHECK(b.error() < 1e-10);
  CHECK(b.system.measured_error() < 1e-10);
  const BladeSweep slit{{0.05, -1, 0.031}, {0.05, 2, 0.031}, {0.05, -1, 0.2}, {0.05, 2, 0.2}};
  const auto opened = b.topology.apply({{}, detail::swept_faces(b.topology, slit, rest)});
  CHECK(!opened.copies.empty());
  b.last = b.system.update(b.topology, opened);
  CHECK(b.last->smallest < 0.5);
  CHECK(b.error() < 1e-10);
  b.fold();
  CHECK(b.error() < 1e-10);
}

TEST_CASE("random cuts until nothing is supported: accurate after every cut", "[cut][extreme][F1]") {
  for (const auto split : {BoxSplit::five_mirrored, BoxSplit::six}) {
    const auto mesh = box_tet4({0.1, 0.1, 0.1}, {3, 3, 3}, split);
    CutBlock<Tet4> b(mesh, hanging(), top_of(mesh));
    testing::Random random(split == BoxSplit::six ? 5 : 6);
    double worst = 0.0;
    int renewed = 0;
    for (int cut = 0; cut < 60; ++cut) {
      CutOrder order;
      for (int k = 0; k < 3; ++k) {
        const auto e = static_cast<Index>(random.uniform(0.0, static_cast<double>(mesh.element_count())));
        if (random.uniform() < 0.4)
          order.remove.push_back(e);
        else
          for (int f = 0; f < 4; ++f) order.open.push_back({e, f});
      }
      b.cut(order);
      if (b.renew_if_inaccurate()) ++renewed;
      REQUIRE(b.system.displacement().allFinite());
      worst = std::max(worst, b.error());
    }
    INFO(worst << ", renewed " << renewed << " times, with " << b.topology.detached_fragments().size()
               << " detached fragments");
    CHECK(worst < 1e-10);
    CHECK(renewed < 20);
    CHECK(b.topology.detached_fragments().size() > 3);
    CutOrder rest;
    for (Index e = 0; e < mesh.element_count(); ++e) rest.remove.push_back(e);
    b.cut(rest);
    b.fold();
    CHECK(b.system.displacement().allFinite());
    const auto step = b.system.folded_step();
    CHECK(step->compliance->topLeftCorner(step->old, step->old).allFinite());
  }
}

TEST_CASE("a factor that was started before the last cuts applies them as one", "[cut][extreme][F1]") {
  const auto mesh = box_tet4({0.1, 0.1, 0.1}, {4, 3, 3}, BoxSplit::six);
  testing::Random random(9);
  for (int begun = 0; begun < 12; ++begun) {
    CutBlock<Tet4> b(mesh, hanging(), top_of(mesh));
    const auto cut = [&] {
      CutOrder order;
      for (int k = 0; k < 5; ++k) {
        const auto e = static_cast<Index>(random.uniform(0.0, static_cast<double>(mesh.element_count())));
        if (k < 2)
          order.remove.push_back(e);
        else
          for (int f = 0; f < 4; ++f) order.open.push_back({e, f});
      }
      b.topology.apply(order);
    };
    for (int k = 0; k < begun; ++k) cut();
    std::vector<NodeId> kept;
    for (const NodeId node : top_of(mesh))
      if (b.is_constrained(node)) kept.push_back(node);
    detail::CutRenewal<Tet4> renewal(b.topology, b.physics, kept, {});
    for (int k = 0; k < 6; ++k) cut();
    while (!renewal.is_done()) std::this_thread::yield();
    auto made = renewal.take(b.topology);
    REQUIRE(made);
    b.system = std::move(*made);
    CHECK(b.error() < 1e-10);
  }
}

TEST_CASE("displacements of all nodes under a surface load equal those of a new model", "[cut]") {
  const auto mesh = box_tet4({0.1, 0.08, 0.06}, {4, 4, 3});
  CutBlock<Tet4> b(mesh, hanging(), top_of(mesh));
  b.cut({{20, 21}, {{60, 0}, {60, 1}, {60, 2}, {60, 3}}});
  b.cut({{80}, {}});
  const std::vector<std::pair<NodeId, Vector3>> forces{{top_of(mesh)[7], {0.1, 0.2, -0.5}}};
  const VectorX u = b.system.displacement_with(forces);
  detail::CutSystem<Tet4> fresh(b.topology, b.physics, top_of(mesh));
  const VectorX truth = fresh.displacement_with(forces);
  double wrong = 0.0;
  for (NodeId node = 0; node < b.topology.mesh().node_count(); ++node)
    if (b.is_constrained(node)) wrong = std::max(wrong, (u - truth).segment<3>(3 * Index{node}).norm());
  CHECK(wrong < 1e-10 * truth.cwiseAbs().maxCoeff());
}

TEST_CASE("a column cut to half its width is twice as soft", "[cut]") {
  // Parallel bars in tension, nu = 0: the closed form N L / (E A) before and after half of the bars are cut.
  const auto mesh = box_tet4({0.02, 0.02, 0.1}, {2, 2, 6}, BoxSplit::six);
  const Scene scene = Scene().fix("z0").traction("z1", {0.0, 0.0, 10.0});
  CutPhysics<Tet4> physics(make_body(mesh, LinearElastic{.youngs_modulus = 1e4, .poisson_ratio = 0.0, .density = 0.0}),
                           extract_boundary<Tet4>(mesh), scene);
  CutTopology<Tet4> topology(mesh, resolve_essential(mesh, extract_boundary<Tet4>(mesh), scene).constrained);
  const NodeId tip = mesh.find_group("z1")->nodes[0];
  detail::CutSystem<Tet4> system(topology, physics, {tip});
  CHECK(std::abs(system.displacement()[3 * Index{tip} + 2] - 10.0 * 0.1 / 1e4) < 1e-12);
  // Remove every second column of cells. The load per column does not change: a column takes its own traction with it.
  CutOrder order;
  for (Index e = 0; e < mesh.element_count(); ++e)
    if (element_nodes<Tet4>(mesh, e).col(0).mean() > 0.01) order.remove.push_back(e);
  system.update(topology, topology.apply(order));
  CHECK(std::abs(system.displacement()[3 * Index{tip} + 2] - 10.0 * 0.1 / 1e4) < 1e-12);
}

TEST_CASE("hexahedra are cut like tetrahedra", "[cut]") {
  const auto mesh = box_hex8({0.1, 0.08, 0.06}, {4, 3, 3});
  CutBlock<Hex8> b(mesh, Scene().fix("z0").gravity({0.0, 0.0, -9.81}), mesh.find_group("z1")->nodes);
  b.cut({{13, 30}, {{20, 0}, {20, 1}, {20, 2}}});
  b.cut({{5}, {{9, 3}, {9, 4}, {9, 5}, {10, 3}}});
  b.fold();
  CHECK(b.error() < 1e-10);
}
