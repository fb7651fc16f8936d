#include "cost.hpp"

#include <sys/resource.h>
#include <sys/wait.h>

#include <algorithm>
#include <fcntl.h>
#include <fstream>
#include <stdexcept>
#include <unistd.h>

namespace {

std::string joined(const Command& command) {
  std::string text;
  for (const auto& word : command) text += (text.empty() ? "" : " ") + word;
  return text;
}

[[noreturn]] void become(const Command& command, const std::string& output) {
  if (!output.empty()) {
    const int file = open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    if (file < 0 || dup2(file, STDOUT_FILENO) < 0) _exit(126);
  }
  std::vector<char*> words;
  for (const auto& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  execvp(words[0], words.data());
  _exit(127);
}

double seconds(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

Command with(Command command, std::initializer_list<std::string> more) {
  command.insert(command.end(), more);
  return command;
}

long count_lines(const std::string& path) {
  std::ifstream file(path);
  return std::count(std::istreambuf_iterator<char>(file), {}, '\n');
}

/// Parses the output of `size`: a header line, then a line that begins with the size of the text section.
long text_size(const std::string& path) {
  std::ifstream file(path);
  std::string names;
  std::getline(file, names);
  long text = 0;
  file >> text;
  return text;
}

}  // namespace

Cost run(const Command& command, const std::string& output) {
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("cannot create a process");
  if (child == 0) become(command, output);
  int status = 0;
  rusage usage{};
  if (wait4(child, &status, 0, &usage) != child || !WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw std::runtime_error("failed: " + joined(command));
#if defined(__APPLE__)
  constexpr double unit = 1e-6;  // bytes
#else
  constexpr double unit = 1024e-6;  // KiB
#endif
  return {seconds(usage.ru_utime) + seconds(usage.ru_stime), unit * static_cast<double>(usage.ru_maxrss)};
}

Cost compile(const Command& compiler, const std::string& source, const std::string& object, bool sizes) {
  Cost cost = run(with(compiler, {"-c", source, "-o", object}));
  if (!sizes) return cost;
  run(with(compiler, {"-E", "-P", source, "-o", object + ".i"}));
  run({"size", object}, object + ".size");
  cost.lines = count_lines(object + ".i");
  cost.text = text_size(object + ".size");
  return cost;
}

Cost median(const std::vector<Cost>& costs) {
  const auto middle = [&](auto member) {
    std::vector<std::decay_t<decltype(costs[0].*member)>> values;
    for (const Cost& c : costs) values.push_back(c.*member);
    std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
    return values[values.size() / 2];
  };
  return {middle(&Cost::seconds), middle(&Cost::megabytes), middle(&Cost::text), middle(&Cost::lines)};
}
