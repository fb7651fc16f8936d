// The binary data of VTU files: raw or base64, as it is or compressed by zlib.
#pragma once

#include <palpate/io/xml/detail/document.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::xml {

/// Bytes that are read in sequence. Base64 may end with padding in the middle: headers are encoded on their own.
class ByteSource {
 public:
  ByteSource(std::string_view data, bool is_base64) : rest_(data), is_base64_(is_base64) {}

  /// The next bytes; fewer if there are no more or the encoding is wrong. Allocates at most the size of the data.
  std::string take(std::size_t bytes);

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
  std::uint64_t number(pugi::xml_node array, ByteSource& source);
  std::string taken(pugi::xml_node array, ByteSource& source, std::size_t bytes);
  std::string decompressed(pugi::xml_node array, ByteSource& source, std::size_t expected);
  [[noreturn]] void refuse_size(pugi::xml_node array, std::size_t expected, std::uint64_t found);

  Document& document_;
  VtuCoding coding_;
  std::size_t decompressed_ = 0;  ///< bytes so far
};

}}}  // namespace palpate::PALPATE_ABI::io::xml

#include <palpate/io/xml/detail/vtu_bytes.ipp>
