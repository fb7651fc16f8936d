// Prints the rows written by the other programs as one table, with the builds of a row below each other.
//   bench_table <rows.csv> <table.csv> <table.md>
#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

namespace {

using Fields = std::array<std::string, 8>;  // target, what, build, figure, baseline, ratio, wanted, verdict
const Fields titles{"target", "what", "build", "figure", "baseline", "ratio", "wanted", "met"};

/// Parses a line "a","b",... whose fields contain no quotes.
Fields parse(const std::string& line) {
  Fields fields;
  std::istringstream in(line);
  std::string piece;
  for (std::string& field : fields) {
    std::getline(in, piece, '"');
    std::getline(in, field, '"');
  }
  return fields;
}

std::string letter_rank(const Fields& row) {
  static const std::array<const char*, 4> before{"machine", "model", "seeds", "scaling"};
  const auto it = std::ranges::find(before, row[0]);
  return row[0] == "machine" ? "0" : it != before.end() ? "2" + row[0] : "1" + row[0];
}

/// Sorted by letter; within a letter in order of first appearance, with the builds of a row together.
std::vector<Fields> sorted(const std::vector<Fields>& rows) {
  std::vector<std::pair<std::string, Fields>> keyed;
  std::vector<std::string> seen;
  for (const Fields& row : rows) {
    auto it = std::ranges::find(seen, row[0] + row[1]);
    if (it == seen.end()) it = seen.insert(seen.end(), row[0] + row[1]);
    std::array<char, 16> place{};
    std::snprintf(place.data(), place.size(), "%06d", static_cast<int>(it - seen.begin()));
    keyed.emplace_back(letter_rank(row) + '|' + place.data(), row);
  }
  std::ranges::stable_sort(keyed, {}, &std::pair<std::string, Fields>::first);
  std::vector<Fields> result;
  for (auto& [key, row] : keyed) result.push_back(std::move(row));
  return result;
}

void write_csv(const std::vector<Fields>& rows, const std::string& path) {
  std::ofstream out(path);
  const auto write = [&](const Fields& row) {
    for (std::size_t i = 0; i < row.size(); ++i) out << (i == 0 ? "\"" : ",\"") << row[i] << '"';
    out << '\n';
  };
  write(titles);
  for (const Fields& row : rows) write(row);
}

/// A Markdown table with columns aligned in the source text.
std::string markdown(const std::vector<Fields>& rows) {
  std::array<std::size_t, 8> width{};
  for (std::size_t i = 0; i < width.size(); ++i) {
    width[i] = titles[i].size();
    for (const Fields& row : rows) width[i] = std::max(width[i], row[i].size());
  }
  std::string text;
  const auto add = [&](const Fields& row, char fill) {
    for (std::size_t i = 0; i < row.size(); ++i)
      text += (i == 0 ? "| " : " | ") + row[i] + std::string(width[i] - row[i].size(), fill);
    text += " |\n";
  };
  add(titles, ' ');
  add({}, '-');
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Fields row = rows[i];
    if (i > 0 && rows[i - 1][0] == row[0] && rows[i - 1][1] == row[1]) row[0] = row[1] = "";
    add(row, ' ');
  }
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  std::ifstream in(argc == 4 ? argv[1] : "");
  if (!in) {
    std::fprintf(stderr, "bench_table <rows.csv> <table.csv> <table.md>\n");
    return 1;
  }
  std::vector<Fields> rows;
  for (std::string line; std::getline(in, line);) rows.push_back(parse(line));
  rows = sorted(rows);
  write_csv(rows, argv[2]);
  const std::string table = markdown(rows);
  std::ofstream(argv[3]) << table;
  std::cout << table;
  const auto count = [&](const std::string& verdict) {
    return std::ranges::count_if(rows, [&](const Fields& r) { return r[7].rfind(verdict, 0) == 0; });
  };
  std::cout << "\nmet " << count("met") << ", not met " << count("not met") << ", not measured "
            << count("not measured") << ", wrong results " << count("WRONG") << '\n';
  return count("WRONG") > 0 ? 1 : 0;
}
