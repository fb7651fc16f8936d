#include "fuzz_reader.hpp"

#include <palpate/io/xml/febio.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fuzz::run([&] { return palpate::io::xml::parse_febio(fuzz::text_of(data, size), "mesh"); });
}
