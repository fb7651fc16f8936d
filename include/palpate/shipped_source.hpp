// For a program that is built without CMake: the models that palpate::compiled contains (model/shipped/shipped.hpp), in
// addition to source.hpp, which describes the use.
#pragma once

#if !defined(PALPATE_COMPILED)
#error "palpate/shipped_source.hpp needs -DPALPATE_COMPILED, in the command that compiles every source of the program"
#else
#include <palpate/model/shipped/hexahedra.inst.ipp>
#include <palpate/model/shipped/tetrahedra.inst.ipp>
#endif
