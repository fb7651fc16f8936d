#include "fuzz_reader.hpp"

#include <palpate/io/veg.hpp>

/// The .veg file and, with the byte 0x1F before it, what every *INCLUDE brings in.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view rest = fuzz::text_of(data, size);
  const std::string_view veg = fuzz::cut(rest);
  return fuzz::run(
      [&] { return palpate::io::veg::parse(veg, "mesh.veg", [&](const std::string&) { return std::string(rest); }); });
}
