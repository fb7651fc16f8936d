#include "fuzz_reader.hpp"

#include <palpate/io/xml/vtu_file.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fuzz::run([&] { return palpate::io::xml::parse_vtu(fuzz::text_of(data, size), "mesh"); });
}
