#include "fuzz_reader.hpp"

#include <palpate/io/read_mesh.hpp>

/// The .veg file and, after the byte 0x1F, the text that every *INCLUDE inserts.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view rest = fuzz::text_of(data, size);
  const std::string_view veg = fuzz::cut(rest);
  return fuzz::run(
      [&] { return palpate::io::veg::parse(veg, "mesh.veg", [&](const std::string&) { return std::string(rest); }); });
}
