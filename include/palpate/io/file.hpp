// Whole files in and out.
#pragma once

#include <palpate/core/setup_error.hpp>

#include <filesystem>
#include <fstream>
#include <initializer_list>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// The whole of a file. Throws bad_file when it cannot be read or is a folder.
inline std::string read_file(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    raise(SetupErrorKind::bad_file, path + ": expected a file, found a folder");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) raise(SetupErrorKind::bad_file, path + ": cannot be opened for reading");
  std::string text;
  constexpr std::size_t block = std::size_t{1} << 20;
  while (stream) {
    const std::size_t size = text.size();
    text.resize(size + block);
    stream.read(text.data() + size, static_cast<std::streamsize>(block));
    text.resize(size + static_cast<std::size_t>(stream.gcount()));
  }
  if (!stream.eof())
    raise(SetupErrorKind::bad_file, path + ": reading stopped after " + std::to_string(text.size()) + " bytes");
  return text;
}

/// Writes the parts one behind the other to a file, replacing it. Throws bad_file.
inline void write_file(const std::string& path, std::initializer_list<std::string_view> parts) {
  std::ofstream stream(path, std::ios::binary | std::ios::trunc);
  if (!stream) raise(SetupErrorKind::bad_file, path + ": cannot be opened for writing");
  for (const std::string_view part : parts) stream.write(part.data(), static_cast<std::streamsize>(part.size()));
  stream.close();
  if (!stream) raise(SetupErrorKind::bad_file, path + ": writing failed");
}

}}}  // namespace palpate::io
