// Pieces that cuts have detached, as rigid bodies: for a physics engine, and to draw them.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/cut/cut_topology.hpp>
#include <palpate/local/mass.hpp>
#include <palpate/mesh/surface.hpp>
#include <palpate/model/haptic_fe_model.hpp>

#include <array>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A piece where it was detached, world frame: as the model has it, displaced as before that cut without tools, or at
/// rest where that was too far for linear elasticity. All of its surface is closed, also where the
/// scene does not draw the body.
struct DetachedPiece {
  double mass = 0.0;                          ///< [kg]
  Vector3 centre = Vector3::Zero();           ///< of mass [m]
  Matrix3 inertia = Matrix3::Zero();          ///< about the centre, axes of the world [kg m^2]
  std::vector<Vector3> points;                ///< of the surface [m]
  std::vector<NodeId> nodes;                  ///< of the points, in the present mesh
  std::vector<std::array<int, 3>> triangles;  ///< outward, of the points
  std::vector<Index> elements;                ///< ascending
};

namespace detail {

/// Adds an element of a piece: `at` its nodes relative to a point of the piece, `moments` the integrals of products of
/// shape functions times the density.
template <Element E>
void add_element(const std::array<Vector3, E::nodes>& at, const ElementMass<E>& moments,
                 DetachedPiece& piece) noexcept {
  for (int a = 0; a < E::nodes; ++a) {
    const Vector3& x = at[static_cast<std::size_t>(a)];
    for (int b = 0; b < E::nodes; ++b) {
      const Vector3& y = at[static_cast<std::size_t>(b)];
      const double m = moments(a, b);
      piece.mass += m;
      piece.centre += m * x;
      piece.inertia += m * (x.dot(y) * Matrix3::Identity() - x * y.transpose());
    }
  }
}

/// From moments about a point of the piece to the centre of mass.
inline void finish_moments(const Vector3& point, DetachedPiece& piece) noexcept {
  piece.centre /= piece.mass;
  const Vector3 c = piece.centre;
  piece.inertia -= piece.mass * (c.squaredNorm() * Matrix3::Identity() - c * c.transpose());
  piece.inertia = (0.5 * (piece.inertia + piece.inertia.transpose())).eval();
  piece.centre += point;
}

/// The faces of a piece without neighbour. `point`: a workspace, -1 for every node; pieces have no node in common.
template <Element E, class PositionOf>
void add_surface(const CutTopology<E>& topology, PositionOf&& position_of, std::vector<int>& point,
                 DetachedPiece& piece) {
  const auto point_of = [&](NodeId node) {
    int& p = point[static_cast<std::size_t>(node)];
    if (p >= 0) return p;
    p = static_cast<int>(piece.points.size());
    piece.points.push_back(position_of(node));
    piece.nodes.push_back(node);
    return p;
  };
  for (const Index e : piece.elements)
    for (std::size_t local = 0; local < E::faces.size(); ++local) {
      if (topology.neighbour(e, local) >= 0) continue;
      const auto face = topology.face_nodes({e, static_cast<int>(local)});
      with_face_element<E>(face.size(), [&]<TriangulatedFace F>() {
        for (const auto& t : F::triangles) {
          const auto at = [&](std::size_t k) { return point_of(face[static_cast<std::size_t>(t[k])]); };
          piece.triangles.push_back({at(0), at(1), at(2)});
        }
      });
    }
}

}  // namespace detail

/// The pieces that cuts have detached from a model that is cut, by ascending lowest element; a piece that is cut again
/// is several. Each call returns all of them: remove the elements of those that an engine has taken over with a
/// CutOrder. Throws bad_density for a piece without mass. Waits for a cut in progress; for any thread but the one that
/// ticks, and for moving tissue for the one that draws. Allocates; O(elements).
template <class E, class M, class Solver>
std::vector<DetachedPiece> detached_pieces(HapticFEModel<E, M, Solver>& model) {
  const VectorX u = model.displacement();
  const Body<E>& body = model.body();
  std::vector<DetachedPiece> pieces;
  model.read([&](const CutTopology<E>& topology, const auto&...) {
    const Mesh<E>& mesh = topology.mesh();
    const auto position_of = [&](NodeId node) -> Vector3 {
      NodeId known = node;  // a cut since the displacement was read
      while (3 * Index{known} >= u.size()) known = topology.copied_from(known);
      return model.to_world() * Vector3(mesh.position(Index{node}) + node_vector(u, Index{known}));
    };
    const auto is_detached = [&](Index e) { return topology.state(e) == ElementState::detached; };
    std::vector<int> point(static_cast<std::size_t>(mesh.node_count()), -1);
    for (detail::Fragment& fragment : detail::connected_fragments(topology, is_detached)) {
      DetachedPiece& piece = pieces.emplace_back();
      const Vector3 origin = position_of(fragment.nodes.front());  // near: far from the world's, moments would cancel
      piece.elements = std::move(fragment.elements);
      std::ranges::sort(piece.elements);
      for (const Index e : piece.elements) {
        std::array<Vector3, E::nodes> at;
        for (int a = 0; a < E::nodes; ++a)
          at[static_cast<std::size_t>(a)] = position_of(static_cast<NodeId>(mesh.element_node(e, a))) - origin;
        const double density = body.density[body.region_of(topology.origin_of_element(e))];
        detail::add_element<E>(at, density * detail::element_mass<E>(element_nodes<E>(mesh, e)), piece);
      }
      if (!(piece.mass > 0.0))
        raise(SetupErrorKind::bad_density, "a detached piece has no mass", "Give the material a density");
      detail::finish_moments(origin, piece);
      detail::add_surface(topology, position_of, point, piece);
    }
  });
  return pieces;
}

}}  // namespace palpate
