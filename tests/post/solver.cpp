// The solver of the accuracy benchmark, for the bodies of these tests.
#include "../../benchmarks/accuracy/solver.cpp"
