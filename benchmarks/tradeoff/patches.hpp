// The constrained and the touchable part of a mesh: from text, or chosen by their position.
#pragma once

#include <palpate/element/tet4.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/mesh/surface.hpp>

#include <optional>
#include <string>
#include <vector>

namespace tradeoff {

using namespace palpate;

/// A finite number, if the whole text is one.
std::optional<double> number_of(const std::string& text);

/// The selection that a text means: the name of a group or region of the mesh, or "surface"; a half space "z<0.01" or
/// "x>-0.02"; "box x0 y0 z0 x1 y1 z1"; "sphere x y z radius" [m]. Throws bad_argument with what is possible.
Selection selection_of(const std::string& text, const Mesh<Tet4>& mesh);

/// Text of the half space that contains the outermost boundary faces in direction +axis (`side` 1) or -axis (-1): the
/// thinnest layer with a twelfth of the area of the boundary.
std::string outermost(const Mesh<Tet4>& mesh, const std::vector<BoundaryFace>& boundary, int axis, int side);

/// The parts of a scene, as text, and which of them were chosen.
struct Patches {
  std::string constrained, touched;
  std::string remark;  ///< a sentence per part that was chosen; empty when both were given
};

/// Chooses the parts that are not given: constrained is the lowest part of the boundary (-z), touched the part opposite
/// to the constrained one, along the axis in which that is farthest from the middle of the body; constrained opposite
/// to what is touched when that is given. Throws the errors of `selection_of` and of resolving; bad_argument when every
/// touchable node would be constrained.
Patches choose_patches(const Mesh<Tet4>& mesh, const std::vector<BoundaryFace>& boundary,
                       const std::string& constrained, const std::string& touched);

}  // namespace tradeoff
