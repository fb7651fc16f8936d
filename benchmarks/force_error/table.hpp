// The table of efficiency: estimated over true errors, and what they add up to.
#pragma once

#include <string>
#include <vector>

#include "cell.hpp"

namespace force_error {

/// Error of the true forces, relative, per depth.
using TruthError = std::array<double, depths.size()>;

/// Measures it on the block, for every Poisson ratio with spheres of these radii in facets: root mean square of the
/// difference from a mesh with edges half as long, the largest of all. Prints it.
TruthError measure_truth_error(const TestBody& block, const std::vector<double>& poisson_ratios, double per_facet);

/// How often an estimate was right.
struct Efficiency {
  int cells = 0, within = 0;
  void add(double ratio) {
    ++cells;
    within += ratio >= 0.5 && ratio <= 2.0;
  }
};

/// Cells whose true error is below twice the error of the truth count apart: nothing follows from their ratio.
class Table {
 public:
  explicit Table(const TruthError& truth_error) : truth_error_(truth_error) {}

  /// Prints the cells of one model, one per depth.
  void add(const Case& test, double per_facet, const char* element, const Forces& truth, const Answer& answer);
  void print_worst() const;
  void print_sum() const;
  /// The expected error within 0.5 to 2 of the true one in 90 % of the cells, no bound below 0.3 of it without a flag,
  /// the truth inside the bound in 95 % of the presses.
  bool is_good() const;

 private:
  struct Cell {
    std::string name;
    double ratio = 0.0, real = 0.0, expected = 0.0;
  };

  TruthError truth_error_;
  std::vector<Cell> cells_;
  Efficiency measured_, recovered_, measured_beside_recovered_;
  int all_ = 0, small_ = 0, same_mesh_ = 0, low_ = 0, presses_ = 0, inside_ = 0;
  double before_ = 0.0, after_ = 0.0;  // squares of relative errors
};

}  // namespace force_error
