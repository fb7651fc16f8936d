// Definitions of recorder.hpp.
#pragma once

#include <palpate/device/recorder.hpp>

#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <locale>
#include <sstream>

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

}}}  // namespace palpate::detail

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void write_recording(const std::string& path, std::span<const RecordedTick> ticks) {
  std::ofstream stream(path, std::ios::binary | std::ios::trunc);
  if (!stream)
    raise(SetupErrorKind::bad_file, path + ": not open for writing: " + std::generic_category().message(errno));
  std::string text(recording_header);
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

}}  // namespace palpate
