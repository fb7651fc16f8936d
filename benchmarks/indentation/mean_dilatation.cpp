#include <palpate/element/mean_dilatation.hpp>

#include "layer.hpp"

template bool indentation::force_converges<palpate::MeanDilatation<palpate::Hex8>>(const char*);
