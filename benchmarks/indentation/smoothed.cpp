#include <palpate/element/wrappers.hpp>

#include "layer.hpp"

template bool indentation::force_converges<palpate::Smoothed<palpate::Tet4>>(const char*);
