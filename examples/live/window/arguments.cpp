#include "arguments.hpp"

#include <palpate/io/decimal.hpp>

#include <functional>
#include <iostream>
#include <map>
#include <sstream>

namespace live {

namespace {

constexpr const char* usage =
    R"(live [MESH --fix GROUP --touch GROUP] [--scene palpate|retract|grasp|cut|beating] [--solver NAME]
     [--device mouse|openhaptics|dhd|chai3d|replay FILE]
  --solver NAME       Tet4, Smoothed<Tet4>, Tet10, QuasiNewton, Cuttable: what the organ is computed with at first
  --script FILE       scripted input instead of the mouse; "scene": that of the scene
  --seconds S, --frames N   close the window then
  --screenshot FILE   write the last frame as PNG; --at S: the one at S seconds
  --film PREFIX       write ten frames a second as PNG, PREFIX0001.png and so on; with --virtual
  --record FILE       write all ticks as CSV, for --device replay FILE
  --out DIR           folder for what the keys R, P and V write
  --size WxH          of the window
  --virtual           in virtual time: the same in every run
  --no-drawing, --no-error-bars, --reveal, --stress, --trouble
)";

bool read_size(const std::string& text, Arguments& a) {
  char times = 0;
  std::istringstream in(text);
  return static_cast<bool>(in >> a.width >> times >> a.height) && times == 'x' && a.width >= 64 && a.height >= 64 &&
         a.width <= 8192 && a.height <= 8192;
}

bool read_number(const std::string& text, double& value) {
  return palpate::io::parse_decimal(text, value) == std::errc{} && value >= 0.0 && value < 1e6;
}

bool read_device(const std::string& name, const std::function<std::string()>& next, Arguments& a) {
  a.device = name;
  if (name == "replay") a.replay = next();
  return name == "mouse" || name == "openhaptics" || name == "dhd" || name == "chai3d" || !a.replay.empty();
}

}  // namespace

std::optional<Arguments> read_arguments(int count, char** values) {
  Arguments a;
  const std::map<std::string, std::string*> texts{
      {"--scene", &a.scene},           {"--fix", &a.fix},       {"--touch", &a.touch},
      {"--solver", &a.composition},    {"--script", &a.script}, {"--record", &a.record},
      {"--screenshot", &a.screenshot}, {"--out", &a.out},       {"--film", &a.film}};
  const std::map<std::string, bool*> switches{
      {"--virtual", &a.virtual_time}, {"--reveal", &a.reveal}, {"--stress", &a.stress}, {"--trouble", &a.trouble}};
  int i = 1;
  const auto next = [&]() -> std::string { return i + 1 < count ? values[++i] : ""; };
  for (; i < count; ++i) {
    const std::string word = values[i];
    if (word == "--help") {
      std::cout << usage;
      return {};
    }
    double frames = 0.0;
    bool understood = true;
    if (const auto text = texts.find(word); text != texts.end())
      understood = !(*text->second = next()).empty();
    else if (const auto on = switches.find(word); on != switches.end())
      *on->second = true;
    else if (word == "--no-drawing")
      a.drawing = false;
    else if (word == "--no-error-bars")
      a.error_bars = false;
    else if (word == "--seconds")
      understood = read_number(next(), a.seconds);
    else if (word == "--at")
      understood = read_number(next(), a.screenshot_at);
    else if (word == "--frames" && (understood = read_number(next(), frames)))
      a.frames = static_cast<long>(frames);
    else if (word == "--size")
      understood = read_size(next(), a);
    else if (word == "--device")
      understood = read_device(next(), next, a);
    else if (word[0] != '-' && a.mesh.empty())
      a.mesh = word;
    else
      understood = false;
    if (understood) continue;
    std::cerr << "live: " << word << " is not understood\n" << usage;
    return {};
  }
  return a;
}

}  // namespace live
