#include "solve_all_of.hpp"

template void solve_case::solve_all<palpate::Hex8>(const CaseFile&, const Arguments&);
