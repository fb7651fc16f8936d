// Definitions of recorder.hpp.
#pragma once

#include <palpate/device/recorder.hpp>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <fstream>
#include <locale>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>
#include <version>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The shortest decimal text that reads back as exactly `value`, with a decimal point in every locale.
inline void append_number(std::string& text, double value) {
  if (std::isnan(value)) {
    text += "nan";  // sign and payload of NaN are not kept
    return;
  }
#ifdef __cpp_lib_to_chars
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  text.append(digits.data(), end);
#else
  if (std::isinf(value)) {
    text += value > 0.0 ? "inf" : "-inf";
    return;
  }
  std::ostringstream stream;
  stream.imbue(std::locale::classic());
  stream.precision(17);
  stream << value;
  text += stream.str();
#endif
}

inline void append_tick(std::string& text, const RecordedTick& tick) {
  const ToolState& s = tick.state;
  append_number(text, s.time);
  const auto add = [&](double value) { append_number(text += ',', value); };
  for (double x : s.position) add(x);
  for (double v : s.velocity) add(v);
  for (double q : s.orientation) add(q);
  text += ',' + std::to_string(s.buttons) + (s.valid ? ",1" : ",0");
  for (double f : tick.force) add(f);
  text += ',' + std::to_string(tick.status.bits());
  add(tick.expected_error);
  add(tick.error_bound);
  add(s.now);
  text += tick.starts ? ",1\n" : ",0\n";
}

/// Reads recordings; errors are `path:line: expected ..., found ...`.
class RecordingReader {
 public:
  RecordingReader(std::string_view text, std::string path) : text_(text), path_(std::move(path)) {}

  std::vector<RecordedTick> ticks() {
    std::vector<RecordedTick> all;
    next_line();
    has_now_ = line_ == recording_header;
    has_errors_ = has_now_ || line_ == recording_header_without_now;
    if (!has_errors_ && line_ != recording_header_without_errors)
      refuse("the header " + std::string(recording_header), line_.substr(0, 60));
    while (next_line())
      if (!line_.empty()) all.push_back(tick());
    if (all.empty()) refuse("at least one tick", "none");
    return all;
  }

 private:
  bool next_line() {
    if (text_.empty()) return false;
    const std::size_t end = std::min(text_.find('\n'), text_.size());
    line_ = text_.substr(0, end);
    text_.remove_prefix(std::min(end + 1, text_.size()));
    if (line_.ends_with('\r')) line_.remove_suffix(1);
    ++line_number_;
    return true;
  }

  RecordedTick tick() {
    RecordedTick t;
    rest_ = line_;
    at_end_ = false;
    t.state.time = real("time");
    for (double& x : t.state.position) x = real("a position");
    for (double& v : t.state.velocity) v = real("a velocity");
    for (double& q : t.state.orientation) q = real("an orientation");
    t.state.buttons = mask("buttons", 0xffffffffu);
    t.state.valid = mask("valid as 0 or 1", 1u) == 1u;
    for (double& f : t.force) f = real("a force");
    const std::uint32_t bits = mask("a status", (1u << status_flag_count) - 1u);
    for (int bit = 0; bit < status_flag_count; ++bit)
      if ((bits >> bit & 1u) != 0u) t.status.set(static_cast<StatusFlag>(1u << bit));
    if (has_errors_) {
      t.expected_error = real("an expected error");
      t.error_bound = real("a bound of the error");
    }
    if (has_now_) {
      t.state.now = real("the present time");
      t.starts = mask("starts as 0 or 1", 1u) == 1u;
    }
    if (!at_end_) refuse(has_now_ ? "21 fields" : has_errors_ ? "19 fields" : "17 fields", "more");
    return t;
  }

  std::string_view field(std::string_view what) {
    if (at_end_) refuse(what, "the end of the line");
    const std::size_t comma = std::min(rest_.find(','), rest_.size());
    at_end_ = comma == rest_.size();
    const std::string_view word = rest_.substr(0, comma);
    rest_.remove_prefix(std::min(comma + 1, rest_.size()));
    return word;
  }

  double real(std::string_view what) {
    const std::string_view word = field(what);
    if (word == "nan") return std::numeric_limits<double>::quiet_NaN();
    if (word == "inf" || word == "-inf") return word[0] == '-' ? -infinity : infinity;
    double value = 0.0;
#ifdef __cpp_lib_to_chars
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool good = error == std::errc{} && end == word.data() + word.size();
#else
    std::istringstream stream{std::string(word)};
    stream.imbue(std::locale::classic());
    stream >> value;
    const bool good = stream && stream.peek() == std::istringstream::traits_type::eof();
#endif
    if (!good) refuse(std::string(what) + " as a number", word);
    return value;
  }

  std::uint32_t mask(std::string_view what, std::uint32_t most) {
    const std::string_view word = field(what);
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size() || value > most) refuse(what, word);
    return value;
  }

  [[noreturn]] PALPATE_COLD void refuse(std::string_view expected, std::string_view found) const {
    std::string text(found.substr(0, 60));
    for (char& c : text)
      if (c < ' ' || c > '~') c = '?';
    raise(SetupErrorKind::bad_file, path_ + ':' + std::to_string(std::max(line_number_, 1)) + ": expected " +
                                        std::string(expected) + ", found '" + text + '\'');
  }

  std::string_view text_, line_, rest_;
  std::string path_;
  int line_number_ = 0;
  bool at_end_ = false, has_errors_ = false, has_now_ = false;
};

}}}  // namespace palpate::detail

namespace palpate { inline namespace PALPATE_ABI {

static_assert(HapticDevice<ReplayDevice>);
static_assert(HapticDevice<Recorder<ReplayDevice>>);

PALPATE_INLINE void write_recording(const std::string& path, std::span<const RecordedTick> ticks) {
  std::ofstream stream(path, std::ios::binary | std::ios::trunc);
  if (!stream)
    raise(SetupErrorKind::bad_file, path + ": not open for writing: " + std::generic_category().message(errno));
  std::string text(detail::recording_header);
  text += '\n';
  for (const RecordedTick& tick : ticks) {
    detail::append_tick(text, tick);
    if (text.size() < std::size_t{1} << 20) continue;
    stream.write(text.data(), static_cast<std::streamsize>(text.size()));
    text.clear();
  }
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  stream.close();
  if (!stream) raise(SetupErrorKind::bad_file, path + ": writing failed", "Is the disk full?");
}

PALPATE_INLINE std::vector<RecordedTick> read_recording(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream)
    raise(SetupErrorKind::bad_file, path + ": not open for reading: " + std::generic_category().message(errno));
  std::string text;
  constexpr std::size_t block = std::size_t{1} << 18;
  while (stream) {
    const std::size_t size = text.size();
    text.resize(size + block);
    stream.read(text.data() + size, static_cast<std::streamsize>(block));
    text.resize(size + static_cast<std::size_t>(stream.gcount()));
  }
  if (!stream.eof()) raise(SetupErrorKind::bad_file, path + ": reading failed", "Is it a folder?");
  return detail::RecordingReader(text, path).ticks();
}

PALPATE_INLINE ReplayDevice::ReplayDevice(std::vector<RecordedTick> ticks, const DeviceLimits& limits)
    : ticks_(std::move(ticks)), rendered_(limits) {
  if (ticks_.empty()) raise(SetupErrorKind::bad_argument, "a recording has no ticks");
}

PALPATE_INLINE ToolState ReplayDevice::read() noexcept {
  const RecordedTick& tick = ticks_[std::min(next_, ticks_.size() - 1)];
  ToolState state = tick.state;
  state.valid = state.valid && !finished();
  restarts_ = tick.starts && next_ > 0 && !finished();
  if (!finished()) ++next_;
  if (tick.starts) last_time_ = 0.0;
  if (state.valid && state.position.allFinite() && std::isfinite(state.time)) last_time_ = state.time;
  if (!std::isfinite(state.now)) state.now = last_time_;  // as a servo takes a state without it
  rendered_.read_was(state.valid);
  return state;
}

}}  // namespace palpate
