#include "isolated.hpp"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <sstream>
#include <stdexcept>

namespace cross {

namespace {

std::string to_line(const Finding& f) {
  std::ostringstream line;
  line.precision(17);
  line << "finding\t" << f.oracle << '\t' << f.tick << '\t' << f.tool << '\t' << f.found << '\t' << f.expected << '\t'
       << f.flagged << '\t' << f.of_torques << '\t' << f.flags << '\n';
  return line.str();
}

std::string to_lines(const Verdict& v) {
  std::ostringstream text;
  text << "refused\t" << v.refused << "\nticks\t" << v.alarms.ticks << '\t' << v.alarms.doubted << '\t'
       << v.alarms.right << '\t' << v.alarms.right_doubted << "\nseconds\t" << v.seconds << '\n';
  std::string lines = text.str();
  for (const Finding& f : v.findings) lines += to_line(f);
  return lines + "end\n";
}

/// Returns whether the text is complete.
bool read_lines(const std::string& text, Verdict& v) {
  std::istringstream in(text);
  bool complete = false;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::vector<std::string> field;
    for (std::string word; std::getline(words, word, '\t');) field.push_back(word);
    field.resize(9);
    if (field[0] == "refused") v.refused = field[1];
    if (field[0] == "ticks")
      v.alarms = {std::stol(field[1]), std::stol(field[2]), std::stol(field[3]), std::stol(field[4])};
    if (field[0] == "seconds") v.seconds = std::stod(field[1]);
    if (field[0] == "finding")
      v.findings.push_back({field[1], std::stoi(field[2]), std::stoi(field[3]), std::strtod(field[4].c_str(), nullptr),
                            std::strtod(field[5].c_str(), nullptr), field[6] == "1", field[8], field[7] == "1"});
    complete = complete || line == "end";
  }
  return complete;
}

[[noreturn]] void child(int pipe, const Scene& scene, const std::function<bool(const Oracle&)>& choose, int seconds) {
  const rlimit time{static_cast<rlim_t>(seconds), static_cast<rlim_t>(seconds)};
  setrlimit(RLIMIT_CPU, &time);
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  for (const int one : {SIGABRT, SIGSEGV, SIGFPE, SIGILL, SIGBUS, SIGTERM})
    std::signal(one, SIG_DFL);  // not the handlers of a test program
  std::string text;
  try {
    text = to_lines(judge(scene, choose));
  } catch (const std::exception& error) {
    Verdict v;
    v.findings.push_back({"exception", 0, 0, 0.0, 0.0, false, error.what()});
    text = to_lines(v);
  }
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t wrote = write(pipe, text.data() + done, text.size() - done);
    if (wrote <= 0) break;
    done += static_cast<std::size_t>(wrote);
  }
  _exit(0);
}

}  // namespace

Verdict judge_isolated(const Scene& scene, const std::function<bool(const Oracle&)>& choose, int seconds) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe");
  std::fflush(nullptr);
  const pid_t process = fork();
  if (process < 0) throw std::runtime_error("no process");
  if (process == 0) {
    close(ends[0]);
    child(ends[1], scene, choose, seconds);
  }
  close(ends[1]);
  std::string text;
  char buffer[4096];
  for (ssize_t got = 0; (got = read(ends[0], buffer, sizeof buffer)) > 0;)
    text.append(buffer, static_cast<std::size_t>(got));
  close(ends[0]);
  int status = 0;
  waitpid(process, &status, 0);
  Verdict v;
  if (read_lines(text, v)) return v;
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  const bool endless = signal == SIGXCPU || signal == SIGKILL;
  v.findings.push_back({endless ? "endless" : "crash", 0, 0, 0.0, static_cast<double>(signal), false, ""});
  return v;
}

}  // namespace cross
