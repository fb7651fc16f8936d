#pragma once

#include <palpate/core/types.hpp>

#include <algorithm>
#include <fstream>
#include <sstream>

namespace test {

/// A matrix of numbers with commas between them and no header; empty when there is no such file.
inline palpate::MatrixX read_matrix(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(file, line);) {
    std::ranges::replace(line, ',', ' ');
    std::istringstream numbers(line);
    rows.emplace_back();
    for (double x = 0.0; numbers >> x;) rows.back().push_back(x);
  }
  palpate::MatrixX m(rows.size(), rows.empty() ? 0 : rows.front().size());
  for (palpate::Index i = 0; i < m.rows(); ++i)
    for (palpate::Index j = 0; j < m.cols(); ++j)
      m(i, j) = rows[static_cast<std::size_t>(i)].at(static_cast<std::size_t>(j));
  return m;
}

inline const std::string two_cubes_folder = PALPATE_TEST_DATA "/oracle/A_two_cubes/tet4/";

}  // namespace test
