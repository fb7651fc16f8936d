// Accuracy per element: comparison with other codes, a manufactured solution, benchmark problems, locking. Prints
// tables in Markdown, and returns 1 when a check fails.
//   bench_accuracy [--oracle <folder>] [--out <folder for convergence.svg>] [--only
//   oracle|manufactured|problems|locking]
#include "parts.hpp"

#include <exception>
#include <filesystem>
#include <stdexcept>

namespace {

struct Arguments {
  std::string oracle = PALPATE_BENCH_ORACLE, out = ".", only;
};

Arguments read_arguments(int argc, char** argv) {
  Arguments a;
  for (int i = 1; i < argc; i += 2) {
    const std::string word = argv[i];
    if (i + 1 == argc) throw std::runtime_error("'" + word + "' needs a value");
    if (word == "--oracle")
      a.oracle = argv[i + 1];
    else if (word == "--out")
      a.out = argv[i + 1];
    else if (word == "--only")
      a.only = argv[i + 1];
    else
      throw std::runtime_error("unknown option '" + word + "'");
  }
  return a;
}

}  // namespace

int main(int argc, char** argv) try {
  using namespace accuracy;
  const Arguments arguments = read_arguments(argc, argv);
  const auto wanted = [&](const char* part) { return arguments.only.empty() || arguments.only == part; };
  Checks checks;
  std::filesystem::create_directories(arguments.out);
  std::printf("# Accuracy\n\n");
  if (wanted("oracle")) compare_with_oracle(arguments.oracle, checks);
  if (wanted("manufactured")) manufactured_solution(arguments.out + "/convergence.svg", checks);
  if (wanted("problems")) benchmark_problems(checks);
  if (wanted("locking")) locking(checks);
  std::printf("%d checks, %d failed.\n", checks.made(), checks.failed());
  return checks.failed() == 0 && checks.made() > 0 ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "bench_accuracy: %s\n", error.what());
  return 2;
}
