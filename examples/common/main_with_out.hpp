// The `main` of an example whose only argument is its output folder.
#pragma once

#include <filesystem>
#include <iostream>
#include <string_view>

namespace example {

/// Calls `run` with the folder of --out DIR and returns its result; 2 when arguments or anything else were refused.
template <class Run>
int main_with_out(int count, char** values, const char* fallback, const Run& run) {
  const bool given = count == 3 && std::string_view(values[1]) == "--out";
  if (count != 1 && !given) {
    std::cerr << "usage: " << values[0] << " [--out DIR]\n";
    return 2;
  }
  try {
    return run(std::filesystem::path(given ? values[2] : fallback));
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}

}  // namespace example
