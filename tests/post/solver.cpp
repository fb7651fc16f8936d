// The solver of the accuracy benchmark, for these tests.
#include "../../benchmarks/accuracy/solver.cpp"
