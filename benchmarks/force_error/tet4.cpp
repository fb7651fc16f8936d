#include "answer.hpp"

template force_error::Answer force_error::answer<palpate::Tet4>(const Case&, bool);
