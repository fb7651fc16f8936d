#include "solve_all_of.hpp"

template void solve_case::solve_all<palpate::Tet4>(const CaseFile&, const Arguments&);
