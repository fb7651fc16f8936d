#include "layer.hpp"

template bool indentation::force_converges<palpate::Tet4>(const char*);
