#include "layer.hpp"

template bool indentation::force_converges<palpate::Tet10>(const char*);
