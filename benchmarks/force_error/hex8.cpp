#include "answer.hpp"

template force_error::Answer force_error::answer<palpate::Hex8>(const Case&, bool);
