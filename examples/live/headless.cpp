// The scenes of `live` without a window, in virtual time: plays the script of a scene and writes the recording.
//
//   live_headless SCENE [--seconds S] [--composition N] [--out FILE.csv]
#include "core/stage.hpp"

#include <palpate/device/recorder.hpp>
#include <palpate/io/decimal.hpp>

#include <chrono>
#include <iostream>

using namespace live;

namespace {

int run_headless(const std::string& name, double seconds, std::size_t composition, const std::string& out) {
  const TouchScene scene = make_scene(name);
  Stage stage(scene, Clock::simulated);
  const Tuning tuning{.friction = scene.session.contact.friction, .error_bars = false};
  const auto begin = std::chrono::steady_clock::now();
  stage.touch(make_organ(scene, scene.compositions.at(composition), tuning), tuning);
  const std::chrono::duration<double> set_up = std::chrono::steady_clock::now() - begin;

  PointerScript script(scene.script);
  stage.log().record(true);
  for (double t = 0.0; t < seconds - 1e-9; t += 0.1) stage.run(0.1, script);  // the queue of ticks holds eight seconds
  const LoopReport report = stage.stop();
  const DurationHistogram& compute = stage.log().compute();
  std::cout << name << ", " << name_of(scene.compositions[composition]) << ": set-up " << set_up.count() << " s, "
            << report.ticks << " ticks of " << 1e6 * compute.percentile(0.5) << " us, p99 "
            << 1e6 * compute.percentile(0.99) << " us, peak force " << report.peak_force << " N, status "
            << report.status << '\n';
  if (!out.empty()) write_recording(out, stage.log().recorded());
  return 0;
}

}  // namespace

int main(int count, char** values) {
  std::string name = "palpate", out;
  double seconds = 3.0, composition = 0.0;
  for (int i = 1; i < count; ++i) {
    const std::string_view word = values[i];
    const std::string value = i + 1 < count ? values[i + 1] : "";
    if (word == "--seconds" && io::parse_decimal(value, seconds) == std::errc{})
      ++i;
    else if (word == "--composition" && io::parse_decimal(value, composition) == std::errc{})
      ++i;
    else if (word == "--out" && !value.empty())
      out = values[++i];
    else
      name = word;
  }
  try {
    return run_headless(name, seconds, static_cast<std::size_t>(composition), out);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
