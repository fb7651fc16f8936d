// A linear tissue on a finer mesh, for measurements at set-up.
#pragma once

#include <palpate/element/tet4.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/model/static/linear_tissue.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Smoothed<Tet4> with the elasticity of every region, and Condensed<SelectiveInverse>. The mesh needs no admission.
class ReferenceTissue : public LinearTissue<double> {
 public:
  /// Throws the errors of the set-up of a model.
  ReferenceTissue(Mesh<Tet4> mesh, std::vector<Matrix6> elasticity, const Scene& scene, const SetupOptions& options);
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/static/detail/reference_tissue.ipp>
#endif
