// Reads tables of numbers from text files.
#pragma once

#include <palpate/core/types.hpp>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace test {

/// Rows of comma-separated numbers after `header_lines` lines; empty when the file does not exist.
inline std::vector<std::vector<double>> read_rows(const std::string& path, int header_lines) {
  std::ifstream file(path);
  std::vector<std::vector<double>> rows;
  std::string line;
  while (header_lines-- > 0) std::getline(file, line);
  while (std::getline(file, line)) {
    std::ranges::replace(line, ',', ' ');
    std::istringstream numbers(line);
    rows.emplace_back();
    for (double x = 0.0; numbers >> x;) rows.back().push_back(x);
  }
  return rows;
}

/// The rows of a file without header, as a matrix.
inline palpate::MatrixX read_matrix(const std::string& path) {
  const auto rows = read_rows(path, 0);
  palpate::MatrixX m(rows.size(), rows.empty() ? 0 : rows.front().size());
  for (palpate::Index i = 0; i < m.rows(); ++i)
    for (palpate::Index j = 0; j < m.cols(); ++j)
      m(i, j) = rows[static_cast<std::size_t>(i)].at(static_cast<std::size_t>(j));
  return m;
}

}  // namespace test
