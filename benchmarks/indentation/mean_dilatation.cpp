#include <palpate/element/wrappers.hpp>

#include "layer.hpp"

template bool indentation::force_converges<palpate::MeanDilatation<palpate::Hex8>>(const char*);
