// A self-contained page with charts and a table.
#pragma once

#include "../01-touch/chart.hpp"

#include <palpate/io/file.hpp>

#include <filesystem>
#include <iostream>
#include <utility>

#ifndef PALPATE_EXAMPLE_DATA
#define PALPATE_EXAMPLE_DATA "examples/data"
#endif

namespace example {

using Figures = std::vector<std::pair<std::string, std::string>>;  ///< name, value

/// Writes FOLDER/report.html, in the style of 01-touch.
inline void write_page(const std::filesystem::path& folder, const std::string& title, const std::string& summary,
                       const std::vector<std::string>& charts, const Figures& figures) {
  std::string page = "<!doctype html><html lang=en><meta charset=utf-8><title>" + title + "</title><style>" +
                     palpate::io::read_file(PALPATE_EXAMPLE_DATA "/../01-touch/page.css") + "</style><main><h1>" +
                     title + "</h1><p>" + summary + "</p>";
  for (const std::string& chart : charts) page += "<section>" + chart + "</section>";
  page += "<table>";
  for (const auto& [what, value] : figures) page += "<tr><th>" + what + "</th><td>" + value + "</td></tr>";
  std::filesystem::create_directories(folder);
  palpate::io::write_file((folder / "report.html").string(), {page + "</table></main></html>\n"});
}

inline void print(const Figures& figures) {
  for (const auto& [what, value] : figures) std::cout << what << ": " << value << '\n';
}

}  // namespace example
