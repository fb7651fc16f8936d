#include "solve_all_of.hpp"

template void solve_case::solve_all<palpate::Tet10>(const CaseFile&, const Arguments&);
