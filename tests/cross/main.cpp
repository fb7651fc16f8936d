// The command `sh cmake/run cross`: random scenes, judged, and those that fail silently made small.
#include "draw.hpp"
#include "isolated.hpp"
#include "known.hpp"
#include "program.hpp"
#include "shrink.hpp"

#include <palpate/testing/random.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>

namespace {

using namespace cross;

struct Arguments {
  std::uint64_t scenes = 200, seed = 1;
  double seconds = 0.0;  // 0: as many as `scenes`
  std::string only, scene, draw, known = PALPATE_CROSS_KNOWN, out = "cross";
  bool program = false, check_known = false, print = false, all = false;
  int shrinks = 1;  // per oracle and solver
  int jobs = 0;
};

constexpr const char* usage =
    "palpate_cross [SCENES] [--seed N] [--seconds N] [--only PATTERN] [--all] [--out FOLDER] [--known FOLDER]\n"
    "              [--shrinks N] [--jobs N] [--print]\n"
    "palpate_cross --scene FILE [--program]\n"
    "palpate_cross --draw N\n"
    "palpate_cross --check-known\n\n"
    "  SCENES         number of scenes (default 200), from --seed (default 1) on; --seconds: stop after that time\n"
    "  --only PATTERN only scenes whose element, law or solver is PATTERN, or only the oracle PATTERN\n"
    "  --all          all oracles on every scene: slow\n"
    "  --out FOLDER   for scenes that fail silently, made small, and their programs (default: cross)\n"
    "  --shrinks N    of each kind of failure, how many are made small (default 1)\n"
    "  --scene FILE   judge one scene with all oracles; --program: print it as a C++ program\n"
    "  --draw N       print the scene of seed N\n"
    "  --check-known  judge the scenes of the folder known: each must still fail\n";

Arguments read_arguments(int count, char** words) {
  Arguments a;
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    const auto next = [&] {
      if (i + 1 >= count) throw std::runtime_error(word + " needs a value");
      return std::string(words[++i]);
    };
    if (word == "--seed")
      a.seed = std::stoull(next());
    else if (word == "--seconds")
      a.seconds = std::stod(next()), a.scenes = ~std::uint64_t{0} / 2;
    else if (word == "--only")
      a.only = next();
    else if (word == "--scene")
      a.scene = next();
    else if (word == "--draw")
      a.draw = next();
    else if (word == "--known")
      a.known = next();
    else if (word == "--out")
      a.out = next();
    else if (word == "--shrinks")
      a.shrinks = std::stoi(next());
    else if (word == "--jobs")
      a.jobs = std::stoi(next());
    else if (word == "--program")
      a.program = true;
    else if (word == "--check-known")
      a.check_known = true;
    else if (word == "--print")
      a.print = true;
    else if (word == "--all")
      a.all = true;
    else if (word[0] == '-')
      throw std::runtime_error("unknown option " + word);
    else
      a.scenes = std::stoull(word);
  }
  return a;
}

bool is_oracle(const std::string& name) {
  return std::any_of(oracles().begin(), oracles().end(), [&](const Oracle& o) { return o.name == name; });
}

/// The oracles of scene `number`: the laws of physics, comparisons by chance, and for one scene in ten the reference.
bool is_chosen(const Oracle& oracle, std::uint64_t number, const Arguments& a) {
  if (a.all) return true;
  if (is_oracle(a.only)) return oracle.name == a.only;
  if (oracle.cost == 0.0) return true;
  if (oracle.name == "reference") return number % 10 == 0;
  if (oracle.cost == 0.5) return number % 2 == 0;  // few scenes can be compared so
  if (oracle.name == "worker") return number % 50 == 0;
  std::size_t index = 0;
  while (oracles()[index].name != oracle.name) ++index;
  palpate::testing::Random mixed(palpate::testing::Random(number * oracles().size() + index).bits());
  return mixed.uniform() < (oracle.cost == 1.0 ? 0.22 : 0.11);
}

void print(const Finding& f) {
  std::printf("  %s: tick %d, tool %d: %.6g, expected %.6g%s%s%s%s\n", f.oracle.c_str(), f.tick, f.tool, f.found,
              f.expected, f.of_torques ? " (torques)" : "", f.flagged ? ", flagged" : ", SILENT",
              f.flags.empty() ? "" : ": ", f.flags.c_str());
}

struct Findings {
  long silent = 0, known = 0, flagged = 0;
};

struct Counts {
  std::uint64_t scenes = 0, refused = 0, ticks = 0, doubted = 0;
  std::uint64_t right = 0, right_doubted = 0;
  std::map<std::string, Findings> oracles;
  std::map<std::string, long> refusals, known, kinds;
  Coverage coverage;
};

/// A sweep over random scenes on all processors.
class Sweep {
 public:
  explicit Sweep(const Arguments& arguments) : a_(arguments), known_(read_known(arguments.known)) {}

  int run() {
    std::filesystem::create_directories(a_.out);
    const unsigned jobs =
        a_.jobs > 0 ? static_cast<unsigned>(a_.jobs) : std::max(1u, std::thread::hardware_concurrency());
    std::vector<std::thread> threads;
    for (unsigned j = 0; j < jobs; ++j) threads.emplace_back([this] { work(); });
    for (std::thread& t : threads) t.join();
    report();
    long silent = 0;
    for (const auto& [name, n] : counts_.oracles) silent += n.silent;
    return silent == 0 ? 0 : 1;
  }

 private:
  double elapsed() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

  void work() {
    for (;;) {
      const std::uint64_t i = next_++;
      if (i >= a_.scenes || (a_.seconds > 0.0 && elapsed() > a_.seconds)) return;
      const std::uint64_t number = a_.seed + i;
      const Scene scene = draw(number);
      if (!a_.only.empty() && !is_oracle(a_.only) && scene.element != a_.only && scene.law != a_.only &&
          scene.solver != a_.only)
        continue;
      judge_one(number, scene);
    }
  }

  void judge_one(std::uint64_t number, const Scene& scene) {
    const Verdict v = judge_isolated(scene, [&](const Oracle& o) { return is_chosen(o, number, a_); });
    std::vector<Finding> to_shrink;
    {
      const std::lock_guard lock(mutex_);
      count(number, scene, v, to_shrink);
    }
    for (const Finding& f : to_shrink) make_small(number, scene, f);
  }

  void count(std::uint64_t number, const Scene& scene, const Verdict& v, std::vector<Finding>& to_shrink) {
    ++counts_.scenes;
    counts_.coverage.add(scene);
    if (!v.refused.empty()) ++counts_.refused, ++counts_.refusals[v.refused];
    counts_.ticks += static_cast<std::uint64_t>(v.alarms.ticks);
    counts_.doubted += static_cast<std::uint64_t>(v.alarms.doubted);
    counts_.right += static_cast<std::uint64_t>(v.alarms.right);
    counts_.right_doubted += static_cast<std::uint64_t>(v.alarms.right_doubted);
    for (const Finding& f : v.findings) {
      Findings& n = counts_.oracles[f.oracle];
      if (f.flagged) {
        ++n.flagged;
        continue;
      }
      const auto cause =
          std::find_if(known_.begin(), known_.end(), [&](const Known& k) { return k.matches(scene, f); });
      if (cause != known_.end()) {
        ++n.known, ++counts_.known[cause->file];
        continue;
      }
      ++n.silent;
      if (a_.print) {
        std::printf("scene %llu, %s %s %s\n", static_cast<unsigned long long>(number), scene.element.c_str(),
                    scene.law.c_str(), scene.solver.c_str());
        print(f);
        std::fflush(stdout);
      }
      if (counts_.kinds[f.oracle + " " + scene.solver]++ < a_.shrinks) to_shrink.push_back(f);
    }
  }

  /// Writes the scene that is left, and its program.
  void make_small(std::uint64_t number, const Scene& scene, const Finding& finding) {
    const auto only = [&](const Oracle& o) { return o.name == finding.oracle; };
    const bool is_crash = !is_oracle(finding.oracle);
    const auto fails = [&](const Scene& s) {
      if (find_composition(s.element, s.law, s.solver) == nullptr) return false;
      if (is_hexahedral(s) && !has_hexahedra(s.body)) return false;
      if (!is_crash && !find_oracle(finding.oracle).applies(s)) return false;
      const Verdict v =
          judge_isolated(s, [&](const Oracle& o) { return is_crash ? is_chosen(o, number, a_) : only(o); });
      return std::any_of(v.findings.begin(), v.findings.end(),
                         [&](const Finding& f) { return f.oracle == finding.oracle && !f.flagged; });
    };
    if (!fails(scene)) return note("scene " + std::to_string(number) + " fails only sometimes: " + finding.oracle);
    const Scene small = shrink(scene, fails);
    std::string name = finding.oracle + "-" + scene.solver + "-" + std::to_string(number);
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c == ' ' || c == '\''; }, '_');
    const std::filesystem::path base = std::filesystem::path(a_.out) / name;
    std::ofstream(base.string() + ".scene") << "# oracle: " << finding.oracle << "\n# found by scene " << number << "\n"
                                            << to_text(small);
    std::ofstream(base.string() + ".cpp") << to_program(small);
    note(base.string() + ".scene: " + std::to_string(size_of(small)) + " lines");
  }

  void note(const std::string& text) {
    const std::lock_guard lock(mutex_);
    std::printf("%s\n", text.c_str());
    std::fflush(stdout);
  }

  void report() const {
    std::printf(
        "\n%llu scenes in %.0f s, %llu refused, %llu ticks of tools, %.2f %% of them with a flag\n",
        static_cast<unsigned long long>(counts_.scenes), elapsed(), static_cast<unsigned long long>(counts_.refused),
        static_cast<unsigned long long>(counts_.ticks),
        100.0 * static_cast<double>(counts_.doubted) / std::max<double>(1.0, static_cast<double>(counts_.ticks)));
    for (const auto& [kind, n] : counts_.refusals) std::printf("  refused as %s: %ld\n", kind.c_str(), n);
    std::printf("\n| oracle | silent | known | flagged |\n|---|---|---|---|\n");
    for (const auto& [name, n] : counts_.oracles)
      std::printf("| %s | %ld | %ld | %ld |\n", name.c_str(), n.silent, n.known, n.flagged);
    if (counts_.right > 0)
      std::printf("\nfalse alarms: %.2f %% of %llu ticks with the force of a reference\n",
                  100.0 * static_cast<double>(counts_.right_doubted) / static_cast<double>(counts_.right),
                  static_cast<unsigned long long>(counts_.right));
    for (const auto& [file, n] : counts_.known) std::printf("  known: %s: %ld\n", file.c_str(), n);
    const auto missing = counts_.coverage.missing();
    const auto all = Coverage::all().size();
    std::printf("\npairs of choices covered: %zu of %zu (%.1f %%)\n", all - missing.size(), all,
                100.0 * static_cast<double>(all - missing.size()) / static_cast<double>(all));
    for (std::size_t i = 0; i < missing.size() && missing.size() <= 40; ++i)
      std::printf("  missing: %s\n", missing[i].c_str());
  }

  const Arguments a_;
  const std::vector<Known> known_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::atomic<std::uint64_t> next_{0};
  std::mutex mutex_;
  Counts counts_;
};

int judge_file(const Arguments& a) {
  std::ifstream in(a.scene);
  if (!in) throw std::runtime_error("cannot read " + a.scene);
  const Scene scene = from_text(in);
  if (a.program) {
    std::printf("%s", to_program(scene).c_str());
    return 0;
  }
  const Verdict v = judge_isolated(scene, [&](const Oracle& o) { return a.only.empty() || o.name == a.only; });
  std::printf("%s%ld ticks of tools, %ld with a flag\n", v.refused.empty() ? "" : (v.refused + ", ").c_str(),
              v.alarms.ticks, v.alarms.doubted);
  if (v.alarms.right > 0)
    std::printf("%ld of %ld ticks with the force of the reference have a flag\n", v.alarms.right_doubted,
                v.alarms.right);
  bool silent = false;
  for (const Finding& f : v.findings) print(f), silent = silent || !f.flagged;
  return silent ? 1 : 0;
}

int check_known(const Arguments& a) {
  int mended = 0;
  for (const Known& k : read_known(a.known)) {
    const Verdict v = judge_isolated(k.scene, [&](const Oracle& o) { return o.name == k.oracles.front(); });
    const bool fails = std::any_of(v.findings.begin(), v.findings.end(), [](const Finding& f) { return !f.flagged; });
    std::printf("%s: %s: %s\n", k.file.c_str(), fails ? "fails as known" : "MENDED: make it a test", k.cause.c_str());
    mended += !fails;
  }
  return mended == 0 ? 0 : 1;
}

}  // namespace

int main(int count, char** words) {
  try {
    const Arguments a = read_arguments(count, words);
    if (!a.draw.empty()) return std::printf("%s", to_text(draw(std::stoull(a.draw))).c_str()) < 0;
    if (!a.scene.empty()) return judge_file(a);
    if (a.check_known) return check_known(a);
    return Sweep(a).run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n\n%s", error.what(), usage);
    return 2;
  }
}
