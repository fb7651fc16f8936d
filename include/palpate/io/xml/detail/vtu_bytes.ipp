// Definitions of vtu_bytes.hpp.
#pragma once

#include <palpate/io/detail/numbers.hpp>
#include <palpate/io/xml/detail/vtu_bytes.hpp>

#include <zlib.h>

#include <algorithm>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace io::xml {

inline std::size_t ByteSource::most_left() const noexcept {
  return is_base64_ ? pending_.size() + rest_.size() / 4 * 3 : rest_.size();
}

/// The value of a base64 digit, 64 for the padding, -1 for any other character.
constexpr int base64_digit(char c) noexcept {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : c == '=' ? 64 : -1;
}

/// Four characters for up to three bytes.
inline bool ByteSource::decode_group() {
  std::uint32_t bits = 0;
  int count = 0, padding = 0;
  while (count < 4 && !rest_.empty()) {
    const char c = rest_.front();
    rest_.remove_prefix(1);
    if (c == ' ' || c == '\n' || c == '\r' || c == '\t') continue;
    const int digit = base64_digit(c);
    if (digit < 0 || (padding > 0 && digit != 64)) return false;
    padding += digit == 64 ? 1 : 0;
    bits = bits << 6U | (static_cast<std::uint32_t>(digit) & 63U);
    ++count;
  }
  if (count < 4 || padding > 2) return false;
  for (int i = 0; i < 3 - padding; ++i) pending_ += static_cast<char>((bits >> (16 - 8 * i)) & 0xFFU);
  return true;
}

inline std::string ByteSource::take(std::size_t bytes) {
  bytes = std::min(bytes, most_left());
  if (!is_base64_) {
    const std::string_view first = rest_.substr(0, bytes);
    rest_.remove_prefix(bytes);
    return std::string(first);
  }
  while (pending_.size() < bytes && decode_group()) {}
  std::string out = pending_.substr(0, bytes);
  pending_.erase(0, bytes);
  return out;
}

inline ByteSource VtuBytes::source_of(pugi::xml_node array) {
  const std::string_view format = document_.need_attribute(array, "format");
  if (format == "binary") {
    if (!array.first_child()) return {{}, true};
    document_.text_of(array);  // refuses other content
    return {array.first_child().value(), true};
  }
  if (format != "appended")
    document_.refuse(array, SetupErrorKind::bad_file, "the format ascii, binary or appended", in_quotes(format));
  const Index offset = document_.integer(array, "offset", 0, static_cast<Index>(coding_.appended.size()));
  return {coding_.appended.substr(static_cast<std::size_t>(offset)), coding_.appended_is_base64};
}

inline void VtuBytes::refuse_size(pugi::xml_node array, std::size_t expected, std::uint64_t found) {
  document_.refuse(array, SetupErrorKind::bad_file, {expected, " bytes in an array"}, {found});
}

inline std::string VtuBytes::taken(pugi::xml_node array, ByteSource& source, std::size_t bytes) {
  std::string data = source.take(bytes);
  if (data.size() != bytes)
    document_.refuse(array, SetupErrorKind::bad_file, {bytes, " bytes of data"}, {"the end after ", data.size()});
  return data;
}

inline std::uint64_t VtuBytes::number(pugi::xml_node array, ByteSource& source) {
  const std::string bytes = taken(array, source, coding_.header_bytes);
  return coding_.header_bytes == 4 ? from_bytes<std::uint32_t>(bytes, coding_.is_swapped)
                                   : from_bytes<std::uint64_t>(bytes, coding_.is_swapped);
}

inline std::string VtuBytes::read(pugi::xml_node array, std::size_t expected) {
  ByteSource source = source_of(array);
  if (coding_.is_compressed) return decompressed(array, source, expected);
  if (const std::uint64_t bytes = number(array, source); bytes != expected) refuse_size(array, expected, bytes);
  return taken(array, source, expected);
}

/// The header has the number of blocks, their size, that of the last one if it is smaller, and all compressed sizes.
inline std::string VtuBytes::decompressed(pugi::xml_node array, ByteSource& source, std::size_t expected) {
  const std::uint64_t blocks = number(array, source), full = number(array, source);
  const std::uint64_t part = number(array, source), last = part == 0 ? full : part;
  if (blocks > source.most_left() / coding_.header_bytes)
    document_.refuse(array, SetupErrorKind::count_too_large, "blocks that fit into the file", {blocks});
  if (blocks == 0 && expected != 0) refuse_size(array, expected, 0);
  if (blocks > 1 && (full == 0 || blocks - 1 > expected / full)) refuse_size(array, expected, blocks);
  if (blocks > 0 && (last > expected || (blocks - 1) * full + last != expected)) refuse_size(array, expected, last);
  decompressed_ += expected;
  if (decompressed_ > most_expansion * coding_.file_size + 65536)
    document_.refuse(array, SetupErrorKind::count_too_large,
                     {"compressed data for at most ", most_expansion, " times the size of the file"}, {decompressed_},
                     "Save it without compression");
  std::vector<std::uint64_t> sizes;
  for (std::uint64_t b = 0; b < blocks; ++b) sizes.push_back(number(array, source));
  std::string out(expected, '\0');
  std::size_t at = 0;
  for (std::uint64_t b = 0; b < blocks; ++b) {
    const std::string packed = taken(array, source, static_cast<std::size_t>(sizes[b]));
    const auto wanted = static_cast<std::size_t>(b + 1 < blocks ? full : last);
    uLongf size = static_cast<uLongf>(wanted);
    const int result = uncompress(reinterpret_cast<Bytef*>(out.data() + at), &size,
                                  reinterpret_cast<const Bytef*>(packed.data()), static_cast<uLong>(packed.size()));
    if (result != Z_OK || size != wanted)
      document_.refuse(array, SetupErrorKind::bad_file, {"a block of ", wanted, " bytes compressed by zlib"},
                       "other data");
    at += wanted;
  }
  return out;
}

}}}  // namespace palpate::PALPATE_ABI::io::xml
