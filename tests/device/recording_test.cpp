// Record, write, read, replay: bitwise equal; and all errors of files.
#include <cfloat>
#include <chrono>
#include <clocale>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <locale>
#include <memory>
#include <palpate/device/mock_device.hpp>
#include <palpate/testing/device_laws.hpp>
#include <palpate/device/recorder.hpp>
#include <palpate/haptic/force_gate.hpp>
#include <palpate/haptic/haptic_loop.hpp>
#include <palpate/testing/random.hpp>

#include "catch.hpp"
#include "device/press_drag_release.hpp"

using namespace palpate;
using palpate::testing::gated;

namespace {

/// A file name in the temporary folder; the file is removed at the end.
struct TemporaryFile {
  explicit TemporaryFile(const std::string& name) {
    const auto stamp = std::chrono::steady_clock::now().time_since_epoch().count();
    path = (std::filesystem::temp_directory_path() / ("palpate_" + std::to_string(stamp) + "_" + name)).string();
  }
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  std::string text() const {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }
  void write(const std::string& content) const { std::ofstream(path, std::ios::binary) << content; }

  std::string path;
};

struct SpringServo {
  ForceGate gate;
  GatedForce force;
  std::span<const GatedForce> tick(std::span<const ToolState> tools) noexcept {
    const ToolState& s = tools.front();
    const Vector3 wanted = -700.0 * s.position - 2.0 * (s.velocity.allFinite() ? s.velocity : Vector3(Vector3::Zero()));
    force = gate.apply(wanted, s.time, s.time, s.valid && s.position.allFinite(), false);
    return {&force, 1};
  }
};

template <class Device>
void run_recorded(Device& device, const std::string& path, double seconds) {
  Recorder recorder(device, 100'000);
  SpringServo servo;
  LoopOptions options;
  options.paced = false;
  options.duration = seconds;
  run_haptic_loop(recorder, servo, options);
  recorder.write_csv(path);
  CHECK(recorder.dropped() == 0);
}

bool same_bits(double a, double b) {
  return std::memcmp(&a, &b, sizeof a) == 0 || (std::isnan(a) && std::isnan(b));
}

bool same(const RecordedTick& a, const RecordedTick& b) {
  bool equal = same_bits(a.state.time, b.state.time) && a.state.buttons == b.state.buttons &&
               same_bits(a.expected_error, b.expected_error) && same_bits(a.error_bound, b.error_bound) &&
               a.state.valid == b.state.valid && a.status == b.status && same_bits(a.state.now, b.state.now) &&
               a.starts == b.starts;
  for (int i = 0; i < 3; ++i)
    equal = equal && same_bits(a.state.position[i], b.state.position[i]) &&
            same_bits(a.state.velocity[i], b.state.velocity[i]) && same_bits(a.force[i], b.force[i]);
  for (std::size_t i = 0; i < 4; ++i) equal = equal && same_bits(a.state.orientation[i], b.state.orientation[i]);
  return equal;
}

std::vector<RecordedTick> random_ticks(int count) {
  constexpr double special[] = {0.0,
                                -0.0,
                                5e-324,
                                DBL_MIN,
                                DBL_MAX,
                                -DBL_MAX,
                                0.1,
                                1.0 / 3.0,
                                infinity,
                                -infinity,
                                std::numeric_limits<double>::quiet_NaN()};
  testing::Random random(21);
  const auto value = [&] {
    if (random.uniform() < 0.2) return special[random.bits() % std::size(special)];
    return std::ldexp(random.uniform(-1.0, 1.0), static_cast<int>(random.bits() % 2000) - 1000);
  };
  std::vector<RecordedTick> ticks(static_cast<std::size_t>(count));
  for (RecordedTick& t : ticks) {
    t.state.time = value();
    for (double& x : t.state.position) x = value();
    for (double& x : t.state.velocity) x = value();
    for (double& x : t.state.orientation) x = value();
    for (double& x : t.force) x = value();
    t.expected_error = value();
    t.error_bound = value();
    t.state.now = value();
    t.starts = random.uniform() < 0.1;
    t.state.buttons = static_cast<std::uint32_t>(random.bits());
    t.state.valid = random.uniform() < 0.5;
    for (int bit = 0; bit < status_flag_count; ++bit)
      if (random.uniform() < 0.5) t.status.set(static_cast<StatusFlag>(1u << bit));
  }
  return ticks;
}

struct DecimalComma : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

/// Sets a locale with decimal commas and grouped thousands during its lifetime, for C++ streams and, if installed, for
/// C.
struct HostileLocale {
  std::locale before = std::locale::global(std::locale(std::locale::classic(), new DecimalComma));
  HostileLocale() { std::setlocale(LC_ALL, "de_DE.UTF-8"); }
  ~HostileLocale() {
    std::locale::global(before);
    std::setlocale(LC_ALL, "C");
  }
};

const std::string header = std::string(detail::recording_header) + '\n';
const std::string row = "0,0,0,0,nan,nan,nan,1,0,0,0,0,1,0,0,0,0,0,inf,0,0\n";
const std::string middle_header = std::string(detail::recording_header_without_now) + '\n';
const std::string middle_row = "0,0,0,0,nan,nan,nan,1,0,0,0,0,1,0,0,0,0,0,inf\n";
const std::string old_header = std::string(detail::recording_header_without_errors) + '\n';
const std::string old_row = "0,0,0,0,nan,nan,nan,1,0,0,0,0,1,0,0,0,0\n";

}  // namespace

TEST_CASE("recordings read back bitwise equal, in any locale", "[device][recording][extreme][C4]") {
  const auto ticks = random_ticks(5000);
  const TemporaryFile file("bits.csv");
  const bool hostile = GENERATE(false, true);
  {
    const std::unique_ptr<HostileLocale> locale = hostile ? std::make_unique<HostileLocale>() : nullptr;
    write_recording(file.path, ticks);
    const auto back = read_recording(file.path);
    REQUIRE(back.size() == ticks.size());
    for (std::size_t i = 0; i < ticks.size(); ++i) REQUIRE(same(ticks[i], back[i]));
  }
  CHECK(file.text().starts_with(header));
}

TEST_CASE("a replay gives the same input and the same forces: the files are equal", "[device][recording]") {
  using Kind = DeviceFault::Kind;
  MockOptions options;
  options.faults = {{.kind = Kind::invalid_read, .first = 300, .count = 5},
                    {.kind = Kind::nan_position, .first = 400, .count = 5},
                    {.kind = Kind::infinite_position, .first = 450},
                    {.kind = Kind::teleport, .first = 500, .offset = Vector3(1, 2, 3)},
                    {.kind = Kind::stall, .first = 600, .seconds = 0.05},
                    {.kind = Kind::frozen, .first = 700, .count = 40}};
  const TemporaryFile first("first.csv"), second("second.csv");
  MockDevice stylus(test::press_drag_release(), options);
  run_recorded(stylus, first.path, 5.0);
  ReplayDevice replay(first.path);
  run_recorded(replay, second.path, 5.0);
  CHECK(replay.finished());
  CHECK(first.text().size() > 100'000);
  CHECK(first.text() == second.text());
}

TEST_CASE("after its end a replay is invalid and renders zero", "[device][recording][extreme][D6]") {
  std::vector<RecordedTick> ticks(3);
  ticks[2].state.position = Vector3(1, 2, 3);
  ReplayDevice replay(ticks);
  replay.start();
  for (int i = 0; i < 3; ++i) CHECK(replay.read().valid);
  CHECK(replay.finished());
  replay.write(gated(Vector3(1, 0, 0)));
  CHECK(replay.last_force() == Vector3(1, 0, 0));
  for (int i = 0; i < 3; ++i) {
    const ToolState s = replay.read();
    CHECK_FALSE(s.valid);
    CHECK(s.position == Vector3(1, 2, 3));
    CHECK(replay.write(gated(Vector3(1, 0, 0))).has(StatusFlag::disconnected));
    CHECK(replay.last_force() == Vector3::Zero());
  }
  CHECK(replay.recorded().size() == 3);
  CHECK_THROWS_AS(ReplayDevice(std::vector<RecordedTick>{}), SetupError);
}

TEST_CASE("a recorder keeps the newest ticks and reports how many it dropped", "[device][recording]") {
  MockDevice stylus(trajectory::poke());
  Recorder recorder(stylus, 10);
  recorder.write(gated(Vector3(1, 0, 0)));  // before any read: forwarded, not recorded
  recorder.note(StatusFlag::inverted);
  CHECK(recorder.ticks().empty());
  recorder.start();
  for (int i = 0; i < 25; ++i) {
    recorder.read();
    recorder.note(StatusFlag::degraded_model);
    recorder.write(gated(Vector3(0.1 * i, 0, 0)));
    if (i == 6) CHECK(recorder.ticks().size() == 7);
    if (i == 6) CHECK(recorder.dropped() == 0);
  }
  const auto ticks = recorder.ticks();
  REQUIRE(ticks.size() == 10);
  CHECK(recorder.dropped() == 15);
  for (int i = 0; i < 10; ++i) {
    CHECK(ticks[static_cast<std::size_t>(i)].state.time == (15 + i) / 1000.0);
    CHECK(ticks[static_cast<std::size_t>(i)].force[0] == 0.1 * (15 + i));
    CHECK(ticks[static_cast<std::size_t>(i)].status == Status(StatusFlag::degraded_model));
  }
  recorder.read();
  CHECK(recorder.ticks().back().force == Vector3::Zero());  // no force written yet
  CHECK_THROWS_AS(Recorder(stylus, 0), SetupError);
}

TEST_CASE("files that are not recordings are refused with file and line",
          "[device][recording][extreme][C1][C2][C3][C5]") {
  struct Case {
    std::string content, line, message;
  };
  const std::vector<Case> cases{
      {"", ":1: ", "header"},
      {"time,x,y\n" + row, ":1: ", "header"},
      {header, ":1: ", "at least one tick"},
      {header + "\n\n", ":3: ", "at least one tick"},
      {header + row + "0,0,0\n", ":3: ", "a position"},
      {header + "0,0,0,0,nan,nan,nan,1,0,0,0,0,1,0,0,0\n", ":2: ", "a status"},
      {header + old_row, ":2: ", "an expected error"},
      {header + row.substr(0, row.size() - 1) + ",1\n", ":2: ", "21 fields"},
      {header + row.substr(0, row.size() - 1) + ",\n", ":2: ", "21 fields"},
      {header + middle_row, ":2: ", "the present time"},
      {header + row.substr(0, row.size() - 2) + "2\n", ":2: ", "starts as 0 or 1"},
      {middle_header + row, ":2: ", "19 fields"},
      {old_header + row, ":2: ", "17 fields"},
      {old_header + old_row.substr(0, old_row.size() - 1) + ",\n", ":2: ", "17 fields"},
      {old_header + "0,1,5,0,0,nan,nan,nan,1,0,0,0,0,1,0,0,0,0\n", ":2: ", "17 fields"},  // decimal comma
      {old_header.substr(0, old_header.size() - 1) + ",expected_error\n" + row, ":1: ", "header"},
      {header + "0;0;0;0;nan;nan;nan;1;0;0;0;0;1;0;0;0;0\n", ":2: ", "time as a number"},
      {header + row + "x,0,0,0,nan,nan,nan,1,0,0,0,0,1,0,0,0,0\n", ":3: ", "time as a number, found 'x'"},
      {header + "1e400,0,0,0,nan,nan,nan,1,0,0,0,0,1,0,0,0,0\n", ":2: ", "time"},
      {header + "0x10,0,0,0,nan,nan,nan,1,0,0,0,0,1,0,0,0,0\n", ":2: ", "time"},
      {header + " 0,0,0,0,nan,nan,nan,1,0,0,0,0,1,0,0,0,0\n", ":2: ", "time"},
      {header + "0,,0,0,nan,nan,nan,1,0,0,0,0,1,0,0,0,0\n", ":2: ", "a position"},
      {header + "0,0,0,0,nan,nan,nan,1,0,0,0,-1,1,0,0,0,0\n", ":2: ", "buttons"},
      {header + "0,0,0,0,nan,nan,nan,1,0,0,0,4294967296,1,0,0,0,0\n", ":2: ", "buttons"},
      {header + "0,0,0,0,nan,nan,nan,1,0,0,0,0,2,0,0,0,0\n", ":2: ", "valid"},
      {header + "0,0,0,0,nan,nan,nan,1,0,0,0,0,1,0,0,0," + std::to_string(1u << status_flag_count) + "\n",
       ":2: ", "a status"},
      {header + std::string(1000, '\x01') + "\n", ":2: ", "time"},
  };
  const TemporaryFile file("bad.csv");
  for (const Case& c : cases) {
    file.write(c.content);
    INFO(c.content.substr(0, 200));
    try {
      const std::size_t ticks = read_recording(file.path).size();
      FAIL("accepted as " << ticks);
    } catch (const SetupError& error) {
      CHECK(error.kind() == SetupErrorKind::bad_file);
      CHECK_THAT(std::string(error.what()), test::contains(file.path + c.line));
      CHECK_THAT(std::string(error.what()), test::contains(c.message));
    }
  }
}

TEST_CASE("files with any line ends, also without the last one, are read", "[device][recording][extreme][C5]") {
  const TemporaryFile file("ends.csv");
  std::string crlf;
  for (char c : header + row + row) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
  for (const std::string& text :
       {header + row + row, header + row + row.substr(0, row.size() - 1), crlf, header + row + "\n" + row}) {
    file.write(text);
    CHECK(read_recording(file.path).size() == 2);
  }
}

TEST_CASE("a recording without errors, as earlier versions wrote it, is read", "[device][recording]") {
  const TemporaryFile file("old.csv");
  REQUIRE(old_header == "time,x,y,z,vx,vy,vz,qw,qx,qy,qz,buttons,valid,fx,fy,fz,status\n");
  file.write(old_header + "1,2,3,4,nan,nan,nan,1,0,0,0,5,1,6,7,8,2\n" + old_row);
  const auto ticks = read_recording(file.path);
  REQUIRE(ticks.size() == 2);
  CHECK(ticks[0].force == Vector3(6, 7, 8));
  CHECK(ticks[0].status.has(StatusFlag::saturated));
  CHECK(ticks[0].expected_error == 0.0);
  CHECK(std::isinf(ticks[0].error_bound));
}

TEST_CASE("a recording without the present time, as earlier versions wrote it, is read", "[device][recording]") {
  const TemporaryFile file("middle.csv");
  REQUIRE(middle_header ==
          "time,x,y,z,vx,vy,vz,qw,qx,qy,qz,buttons,valid,fx,fy,fz,status,expected_error,error_bound\n");
  file.write(middle_header + "7,2,3,4,nan,nan,nan,1,0,0,0,5,1,6,7,8,2,0.25,0.5\n" + middle_row);
  const auto ticks = read_recording(file.path);
  REQUIRE(ticks.size() == 2);
  CHECK(ticks[0].error_bound == 0.5);
  CHECK(std::isnan(ticks[0].state.now));
  CHECK_FALSE(ticks[0].starts);
  ReplayDevice replay(file.path);
  CHECK(replay.read().now == 7.0);  // as if measured when it is read
}

TEST_CASE("a recorder keeps the force that was rendered, not a second one", "[device][recording]") {
  MockDevice stylus(trajectory::poke());
  Recorder recorder(stylus, 4);
  recorder.start();
  recorder.read();
  recorder.write(gated(Vector3(1, 0, 0)));
  recorder.write(GatedForce{});  // the end of a loop
  CHECK(stylus.last_force() == Vector3::Zero());
  CHECK(recorder.ticks()[0].force == Vector3(1, 0, 0));
}

TEST_CASE("a recorder keeps the age of poses and marks starts; a replay repeats both", "[device][recording]") {
  MockDevice stylus(trajectory::poke(), {.faults = {{.kind = DeviceFault::Kind::frozen, .first = 3, .count = 2}}});
  Recorder recorder(stylus, 100);
  for (int start = 0; start < 2; ++start) {
    recorder.start();
    for (int k = 0; k < 5; ++k) recorder.read();
    recorder.stop();
  }
  recorder.read();
  recorder.note(StatusFlag::stale, 77.0);  // the present time of a loop
  recorder.note(StatusFlag::stale);
  const TemporaryFile file("starts.csv");
  recorder.write_csv(file.path);
  ReplayDevice replay(file.path);
  REQUIRE(replay.recorded().size() == 11);
  Recorder again(replay, 100);
  for (int k = 0; k < 11; ++k) {
    INFO(k);
    const RecordedTick& tick = replay.recorded()[static_cast<std::size_t>(k)];
    const ToolState state = again.read();
    CHECK(state.now == (k == 10 ? 77.0 : k / 1000.0));
    CHECK(state.time == (k == 3 || k == 4 ? 2 : k) / 1000.0);
    CHECK(tick.starts == (k % 5 == 0 && k < 10));
    CHECK(replay.restarts() == (k == 5));  // the first one is the start of the replay
    CHECK(again.restarts() == replay.restarts());
    CHECK(again.ticks().back().starts == (k == 5));
  }
  again.read();
  CHECK_FALSE(replay.restarts());
}

TEST_CASE("a recorder keeps the error of every force", "[device][recording][force_error]") {
  MockDevice stylus(trajectory::poke());
  Recorder recorder(stylus, 4);
  recorder.start();
  recorder.read();
  GatedForce force = gated(Vector3(1, 0, 0));
  force.error = {0.25, 0.5, 1.0, {0.5}};
  recorder.write(force);
  recorder.read();
  CHECK(recorder.ticks()[0].expected_error == 0.25);
  CHECK(recorder.ticks()[0].error_bound == 0.5);
  CHECK(std::isinf(recorder.ticks()[1].error_bound));  // nothing written
}

TEST_CASE("every truncated file is refused or read as complete ticks", "[device][recording][extreme][C1]") {
  const TemporaryFile file("cut.csv");
  const std::string whole = header + row + row;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    file.write(whole.substr(0, size));
    try {
      const std::size_t ticks = read_recording(file.path).size();
      CHECK(ticks <= 2);
      CHECK(size > header.size());
    } catch (const SetupError& error) {
      CHECK(error.kind() == SetupErrorKind::bad_file);
    }
  }
}

TEST_CASE("files that cannot be opened are refused", "[device][recording]") {
  const std::string nowhere = "/no such folder/recording.csv";
  for (auto act : {+[](const std::string& p) { static_cast<void>(read_recording(p)); },
                   +[](const std::string& p) { write_recording(p, {}); }}) {
    try {
      act(nowhere);
      FAIL("accepted");
    } catch (const SetupError& error) {
      CHECK(error.kind() == SetupErrorKind::bad_file);
      CHECK_THAT(std::string(error.what()), test::contains(nowhere));
    }
  }
  CHECK_THROWS_AS(read_recording(std::filesystem::temp_directory_path().string()), SetupError);
}
