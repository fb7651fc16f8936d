#include "layer.hpp"

template bool indentation::force_converges<palpate::Hex8>(const char*);
