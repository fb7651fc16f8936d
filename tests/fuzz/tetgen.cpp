#include "fuzz_reader.hpp"

#include <palpate/io/read_mesh.hpp>

/// The .node, .ele and .face files, separated by the byte 0x1F.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view rest = fuzz::text_of(data, size);
  const std::string_view node = fuzz::cut(rest), ele = fuzz::cut(rest);
  return fuzz::run([&] { return palpate::io::tetgen::parse({"mesh", node, ele, rest}); });
}
