// The arrays of numbers in VTU files, and their binary data: raw or base64, as it is or compressed by zlib.
#pragma once

#include <palpate/io/detail/numbers.hpp>
#include <palpate/io/detail/vtk_numbers.hpp>
#include <palpate/io/xml/detail/document.hpp>

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace io::xml {

/// Bytes that are read in sequence. Base64 may end with padding in the middle: headers are encoded on their own.
class ByteSource {
 public:
  ByteSource(std::string_view data, bool is_base64) : rest_(data), is_base64_(is_base64) {}

  /// The next bytes; fewer if there are no more or the encoding is wrong. Allocates at most the size of the data.
  std::string read_bytes(std::size_t bytes);

  std::size_t most_left() const noexcept;  ///< an upper bound of the bytes left

 private:
  bool decode_group();

  std::string_view rest_;
  std::string pending_;  ///< decoded and not yet taken, at most two bytes
  bool is_base64_;
};

/// The coding of all arrays of a file.
struct VtuCoding {
  bool is_swapped = false;     ///< byte order opposite to that of this machine
  bool is_compressed = false;  ///< by zlib
  std::size_t header_bytes = 4;
  std::string_view appended;  ///< the data after the mark _
  bool appended_is_base64 = false;
  std::size_t file_size = 0;
};

/// Decompressed data of one file may be this many times as large as the file, and 64 KiB more. Meshes reach a tenth of
/// it: their connectivity and coordinates are compressed by less than 15.
inline constexpr std::size_t most_expansion = 128;

/// Decodes the data of arrays.
class VtuBytes {
 public:
  VtuBytes(Document& document, const VtuCoding& coding) : document_(document), coding_(coding) {}

  bool is_swapped() const noexcept { return coding_.is_swapped; }

  /// The `expected` bytes of an array in binary or appended format. Refuses any other size, stated or found.
  std::string read(pugi::xml_node array, std::size_t expected);

 private:
  ByteSource source_of(pugi::xml_node array);
  std::uint64_t number(pugi::xml_node array, ByteSource& source) {
    const std::string bytes = taken(array, source, coding_.header_bytes);
    return coding_.header_bytes == 4 ? from_bytes<std::uint32_t>(bytes, coding_.is_swapped)
                                     : from_bytes<std::uint64_t>(bytes, coding_.is_swapped);
  }
  std::string taken(pugi::xml_node array, ByteSource& source, std::size_t bytes);
  std::string decompressed(pugi::xml_node array, ByteSource& source, std::size_t expected);
  [[noreturn]] void refuse_size(pugi::xml_node array, std::size_t expected, std::uint64_t found) {
    document_.refuse(array, SetupErrorKind::bad_file, {expected, " bytes in an array"}, {found});
  }

  Document& document_;
  VtuCoding coding_;
  std::size_t decompressed_ = 0;  ///< bytes so far
};

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

inline std::string ByteSource::read_bytes(std::size_t bytes) {
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

inline std::string VtuBytes::taken(pugi::xml_node array, ByteSource& source, std::size_t bytes) {
  std::string data = source.read_bytes(bytes);
  if (data.size() != bytes)
    document_.refuse(array, SetupErrorKind::bad_file, {bytes, " bytes of data"}, {"the end after ", data.size()});
  return data;
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

/// The types of numbers, as in legacy files.
inline constexpr std::array vtu_types{
    vtk::NumberType{"Int8", vtk::NumberType::integer, 8},
    vtk::NumberType{"UInt8", vtk::NumberType::unsigned_integer, 8},
    vtk::NumberType{"Int16", vtk::NumberType::integer, 16},
    vtk::NumberType{"UInt16", vtk::NumberType::unsigned_integer, 16},
    vtk::NumberType{"Int32", vtk::NumberType::integer, 32},
    vtk::NumberType{"UInt32", vtk::NumberType::unsigned_integer, 32},
    vtk::NumberType{"Int64", vtk::NumberType::integer, 64},
    vtk::NumberType{"UInt64", vtk::NumberType::unsigned_integer, 64},
    vtk::NumberType{"Float32", vtk::NumberType::real, 32},
    vtk::NumberType{"Float64", vtk::NumberType::real, 64},
};

/// Reads a `<DataArray>` number by number. The size is checked before anything is allocated.
class VtuArray {
 public:
  /// `count` numbers; refuses more and fewer.
  VtuArray(Document& document, VtuBytes& bytes, pugi::xml_node array, Index count);

  Index integer(std::string_view what, Index low, Index high) {
    if (!is_text_) return binary_integer(in_, layout(), what, low, high, SetupErrorKind::index_out_of_range);
    in_.need_more(what);
    return in_.integer(what, low, high);
  }
  double real(std::string_view what);

  /// The next number, unchecked: NaN for a word that is none, or where there is none.
  double any_number() {
    if (!is_text_) return any_binary_number(in_, layout(), type_.kind == vtk::NumberType::real);
    if (in_.rest().empty()) in_.next_line();
    return any_decimal(in_.token());
  }

  /// Refuses more numbers in a text.
  void end() {
    if (!is_text_) return;
    in_.end_line("an array");
    if (in_.next_line()) in_.refuse(SetupErrorKind::bad_file, "the end of an array", in_quotes(in_.line()));
  }

  const TextReader& in() const noexcept { return in_; }
  Index line() const noexcept { return is_text_ ? in_.location() : line_; }  ///< of the next number, or of the array

  static const vtk::NumberType& type_of(Document& document, pugi::xml_node array) {
    const std::string_view type = document.need_attribute(array, "type");
    if (const vtk::NumberType* known = find_type(array)) return *known;
    document.refuse(array, SetupErrorKind::unsupported, "a type of numbers such as Float64", in_quotes(type));
  }

  /// The type of an array, nullptr if it is not known.
  static const vtk::NumberType* find_type(pugi::xml_node array) noexcept;

 private:
  BinaryLayout layout() const noexcept { return {type_.bits, type_.kind == vtk::NumberType::integer, swap_}; }

  const vtk::NumberType& type_;
  bool is_text_, swap_;
  Index line_;
  std::string data_;
  TextReader in_;
};

inline const vtk::NumberType* VtuArray::find_type(pugi::xml_node array) noexcept {
  const std::string_view type = array.attribute("type").value();
  for (const vtk::NumberType& t : vtu_types)
    if (t.name == type) return &t;
  return nullptr;
}

inline VtuArray::VtuArray(Document& document, VtuBytes& bytes, pugi::xml_node array, Index count)
    : type_(type_of(document, array)),
      is_text_(document.need_attribute(array, "format") == "ascii"),
      swap_(bytes.is_swapped()),
      line_(document.line_of(array)),
      in_({}, std::string()) {
  if (is_text_) {
    const std::string_view text = array.first_child().value();
    if (count > static_cast<Index>(text.size()) / 2 + 1)
      document.refuse(array, SetupErrorKind::count_too_large, {count, " numbers in an array"},
                      {text.size(), " bytes of text"});
    in_ = document.text_of(array);
    return;
  }
  data_ = bytes.read(array, static_cast<std::size_t>(count) * static_cast<std::size_t>(type_.bits) / 8);
  const std::string name = array.attribute("Name").value();
  in_ = TextReader(data_, joined({document.place_of(array), ": array '", name, "'"}));
}

inline double VtuArray::real(std::string_view what) {
  if (type_.kind != vtk::NumberType::real) {
    constexpr Index limit = std::numeric_limits<Index>::max();
    return static_cast<double>(integer(what, -limit, limit));
  }
  if (!is_text_) return binary_real(in_, layout(), what);
  in_.need_more(what);
  return in_.real(what);
}

}}}  // namespace palpate::PALPATE_ABI::io::xml
