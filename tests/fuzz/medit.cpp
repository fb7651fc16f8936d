#include "fuzz_reader.hpp"

#include <palpate/io/read_mesh.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fuzz::run([&] { return palpate::io::medit::parse(fuzz::text_of(data, size), "mesh.mesh"); });
}
