#include "solve_all_of.hpp"

template void solve_case::solve_all<palpate::Hex20>(const CaseFile&, const Arguments&);
