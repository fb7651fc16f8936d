// The table of force errors: what models say on the mesh as given against the truth.
#pragma once

#include <string>
#include <vector>

#include "cell.hpp"

namespace force_error {

/// Prints the error of the truth on a case: the difference from a mesh with edges half as long, per tool and depth.
void print_truth_error(const Case& test);

/// A group of presses: errors of those without a flag, how many have one. Presses of models whose set-up reports that
/// the element locks are counted apart.
struct Errors {
  int presses = 0, flagged = 0, locking = 0;
  double sum = 0.0, worst = 0.0;
  std::string where{};
  void add(double error, const Press& press, bool locks, const std::string& name);
  double mean() const { return presses > flagged ? sum / (presses - flagged) : 0.0; }
};

class Table {
 public:
  /// Prints one line per tool and adds it to the groups.
  void add(const Case& test, double per_facet, const char* element, const Presses& truth, const Answer& answer);
  /// Groups by body, element, Poisson ratio, radius, depth, tool; all; the worst presses; the error bars.
  void print() const;
  /// Without the edge, where most presses are flagged: no press without a flag is more than 6 % off, the mean is 3 % or
  /// less, fewer than 5 % are flagged, and the bar contains the truth in 95 % of the measured presses.
  bool is_good() const;

 private:
  Errors& group(const std::string& name);
  struct Named {
    std::string name;
    double error = 0.0;
  };

  std::vector<std::pair<std::string, Errors>> groups_;
  Errors all_;
  std::vector<Named> unflagged_;
  int measured_ = 0, inside_ = 0;
  std::vector<double> bars_;  // relative
};

}  // namespace force_error
