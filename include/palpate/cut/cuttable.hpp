// A solver policy for linear tissue that is cut while it is touched: Cuttable<Condensed<SelectiveInverse>>.
#pragma once

#include <palpate/cut/cuttable_tissue.hpp>
#include <palpate/cut/cut_topology.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/model/policies.hpp>
#include <palpate/model/rendering/visual_surface.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

template <class Inner>
struct Cuttable;

/// Positions, normals and triangles of a body that is cut, including detached fragments: the rendered faces of the
/// scene (default: all) and all faces exposed by cuts. Cuts change points and triangles; `update` applies these
/// changes, and between two calls of it points and triangles are constant. Refers to the model; one reader at a time.
/// `update` and `read_surface` wait for a cut in progress: a renderer that must not wait calls them in another thread.
template <class E, class M, class Inner>
class VisualSurface<HapticFEModel<E, M, Cuttable<Inner>>> {
 public:
  using Model = HapticFEModel<E, M, Cuttable<Inner>>;

  explicit VisualSurface(Model& model) : model_(&model) {
    const auto& boundary = model.boundary();
    rendered_ = model.rendered_nodes();
    kinds_.assign(static_cast<std::size_t>(model.body().mesh.element_count()), {});
    for (const BoundaryFace& face : boundary) note_kind(model.body().mesh, face);
    update();
  }

  /// Applies the cuts since the last call; true when points and triangles have changed. O(elements) in that case.
  bool update() {
    const std::uint64_t cuts = model_->cut_report().changes;
    if (known_ && cuts == cuts_) return false;
    model_->read([&](const CutTopology<E>& topology, const auto&...) { collect(topology); });
    cuts_ = cuts;
    known_ = true;
    return true;
  }

  Index point_count() const noexcept { return static_cast<Index>(nodes_.size()); }
  const std::vector<std::array<int, 3>>& triangles() const noexcept { return triangles_; }
  /// Per point, 1: on faces that cuts have exposed. Nodes on the rim of a wound have two points, so that no triangle
  /// has points of both kinds.
  const std::vector<std::uint8_t>& exposed() const noexcept { return exposed_; }

  /// As VisualSurface of other models; allocates. Also returns false when the model was reset since the last `update`,
  /// and for forces on vertices that no longer exist.
  bool read_surface(std::span<const VertexForce> forces, std::span<float> positions,
                    std::span<float> normals) noexcept {
    const std::size_t size = 3 * nodes_.size();
    if (positions.size() != size || normals.size() != size) return false;
    if (!model_->displacement_with(forces, displacement_).converged) return false;
    if (displacement_.size() < 3 * node_count_) return false;  // the model was reset since `update`
    const Eigen::Isometry3d pose = model_->to_world();
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      moved_[i] = pose * (rest_[i] + node_vector(displacement_, nodes_[i]));
    detail::write_surface(moved_, triangles_, normals_, positions, normals);
    return true;
  }
  /// Displacement of the last read_surface, 3 per node, also of those that cuts have created [m]; empty before the
  /// first.
  const VectorX& displacement() const noexcept { return displacement_; }
  /// Values of a field with one per node at the points. Returns false and writes nothing when a length is wrong.
  bool read_field(const VectorX& at_nodes, std::span<float> values) const noexcept {
    if (at_nodes.size() < node_count_ || values.size() != nodes_.size()) return false;
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(at_nodes[Index{nodes_[i]}]);
    return true;
  }

 private:
  /// Of a face, should it be open.
  enum class FaceKind : std::uint8_t { exposed, rendered, hidden };
  using Kinds = std::array<FaceKind, E::faces.size()>;

  /// Of a face of the uncut body: whether the scene renders it.
  void note_kind(const Mesh<E>& mesh, const BoundaryFace& face) {
    const auto seen = [&](NodeId i) { return std::ranges::binary_search(rendered_, i); };
    const bool hidden = !rendered_.empty() && !std::ranges::all_of(face.nodes, seen);
    for (std::size_t local = 0; local < E::faces.size(); ++local) {
      if (std::ranges::equal(detail::face_ids<E>(mesh, face.element, local), face.nodes))
        kinds_[static_cast<std::size_t>(face.element)][local] = hidden ? FaceKind::hidden : FaceKind::rendered;
    }
  }

  void collect(const CutTopology<E>& topology) {
    nodes_.clear();
    triangles_.clear();
    exposed_.clear();
    std::vector<int> point(2 * topology.mesh().positions.size(), -1);
    const auto point_of = [&](NodeId i, bool exposed) {
      int& p = point[2 * static_cast<std::size_t>(i) + (exposed ? 1 : 0)];
      if (p < 0) {
        p = static_cast<int>(nodes_.size());
        nodes_.push_back(i);
        exposed_.push_back(exposed ? 1 : 0);
      }
      return p;
    };
    for (Index e = 0; e < topology.mesh().element_count(); ++e) {
      if (topology.is_removed(e)) continue;
      const detail::ElementPart<E> part = topology.part(e);
      for (std::size_t local = 0; local < E::faces.size(); ++local) {
        const bool is_given = (part.faces >> local & 1u) != 0;
        const FaceKind kind = is_given ? kinds_[static_cast<std::size_t>(part.whole)][local] : FaceKind::exposed;
        if (topology.neighbour(e, local) >= 0 || kind == FaceKind::hidden) continue;
        const auto face = topology.face_nodes({e, static_cast<int>(local)});
        detail::with_face_element<E>(face.size(), [&]<TriangulatedFace F>() {
          for (const auto& t : F::triangles) {
            const auto at = [&](std::size_t k) {
              return point_of(face[static_cast<std::size_t>(t[k])], kind == FaceKind::exposed);
            };
            triangles_.push_back({at(0), at(1), at(2)});
          }
        });
      }
    }
    node_count_ = topology.mesh().node_count();
    rest_.clear();
    for (const NodeId i : nodes_) rest_.push_back(topology.mesh().position(i));
    moved_.resize(nodes_.size());
    normals_.resize(nodes_.size());
  }

  Model* model_;
  std::vector<NodeId> rendered_;  // sorted
  std::vector<Kinds> kinds_;      // per element and face
  std::vector<NodeId> nodes_;     // of the points
  std::vector<std::uint8_t> exposed_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<Vector3> rest_, moved_, normals_;
  VectorX displacement_;
  Index node_count_ = 0;  // of the topology from which the points were collected
  std::uint64_t cuts_ = 0;
  bool known_ = false;
};

namespace detail {

/// Whether tissue of a solver can be cut.
template <class Solver>
inline constexpr bool has_cuts = std::same_as<Solver, Condensed<SelectiveInverse>>;

}  // namespace detail

/// The solver `Inner` for tissue that is cut: Condensed<SelectiveInverse>, whose compliance follows cuts exactly, or
/// Implicit<QuasiNewton<>> (cut/cuttable_moving.hpp).
template <class Inner>
struct Cuttable {
  static_assert(detail::has_cuts<Inner>,
                "palpate: tissue that is cut is Cuttable<Condensed<SelectiveInverse>>, or with "
                "palpate/cut/cuttable_moving.hpp Cuttable<Implicit<QuasiNewton<>>>");
};

template <class Inner>
struct SolverTraits<Cuttable<Inner>> {
  static_assert(sizeof(Cuttable<Inner>) > 0);  // its error about Inner comes first
  template <class E, class M>
  using Tissue = CuttableTissue<E>;
};

}}  // namespace palpate
