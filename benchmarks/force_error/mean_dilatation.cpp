#include "answer.hpp"

template force_error::Answer force_error::answer<palpate::MeanDilatation<palpate::Hex8>>(const Case&, bool);
