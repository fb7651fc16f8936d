// Include next to palpate.hpp for elements other than Tet4: hexahedra, quadratic elements, MeanDilatation<Hex8>, and
// boxes of them.
#pragma once

#include <palpate/element/hex20.hpp>
#include <palpate/element/hex8.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/mesh/promote.hpp>
