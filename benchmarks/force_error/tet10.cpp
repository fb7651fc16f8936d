#include "answer.hpp"

template force_error::Answer force_error::answer<palpate::Tet10>(const Case&, bool);
