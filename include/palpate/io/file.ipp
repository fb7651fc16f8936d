// Definitions of file.hpp. <filesystem> and <fstream> would double the compile time of a reader.
#pragma once

#include <palpate/io/detail/message.hpp>
#include <palpate/io/file.hpp>

#include <cstdio>

#include <sys/stat.h>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

namespace detail {

/// The file-type bits of a file, 0 if there is no file of that name.
inline unsigned file_kind(const std::string& path) {
  struct stat found {};
  return ::stat(path.c_str(), &found) == 0 ? static_cast<unsigned>(found.st_mode) & static_cast<unsigned>(S_IFMT) : 0U;
}

/// A file that closes itself.
struct OpenFile {
  OpenFile(const std::string& path, const char* mode) : stream(std::fopen(path.c_str(), mode)) {}
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  ~OpenFile() { close(); }
  /// False when the last bytes could not be written.
  bool close() { return stream == nullptr || std::fclose(std::exchange(stream, nullptr)) == 0; }
  std::FILE* stream;
};

}  // namespace detail

PALPATE_INLINE std::string read_file(const std::string& path) {
  if (detail::file_kind(path) == static_cast<unsigned>(S_IFDIR))
    refuse(SetupErrorKind::bad_file, {path, ": expected a file, found a folder"});
  detail::OpenFile file(path, "rb");
  if (file.stream == nullptr) refuse(SetupErrorKind::bad_file, {path, ": cannot be opened for reading"});
  std::string text;
  constexpr std::size_t block = std::size_t{1} << 20;
  for (std::size_t read = block; read == block;) {
    const std::size_t size = text.size();
    text.resize(size + block);
    read = std::fread(text.data() + size, 1, block, file.stream);
    text.resize(size + read);
  }
  if (std::ferror(file.stream) != 0)
    refuse(SetupErrorKind::bad_file, {path, ": reading stopped after ", text.size(), " bytes"});
  return text;
}

PALPATE_INLINE void write_file(const std::string& path, std::initializer_list<std::string_view> parts) {
  detail::OpenFile file(path, "wb");
  if (file.stream == nullptr) refuse(SetupErrorKind::bad_file, {path, ": cannot be opened for writing"});
  bool is_whole = true;
  for (const std::string_view part : parts)
    is_whole = is_whole && std::fwrite(part.data(), 1, part.size(), file.stream) == part.size();
  if (!file.close() || !is_whole) refuse(SetupErrorKind::bad_file, {path, ": writing failed"});
}

PALPATE_COLD PALPATE_INLINE bool is_there(const std::string& path) {
  return detail::file_kind(path) != 0;
}

PALPATE_COLD PALPATE_INLINE bool is_regular_file(const std::string& path) {
  return detail::file_kind(path) == static_cast<unsigned>(S_IFREG);
}

PALPATE_COLD PALPATE_INLINE std::string_view folder_of(std::string_view path) noexcept {
#ifdef _WIN32
  const std::size_t end = path.find_last_of("/\\:");
#else
  const std::size_t end = path.rfind('/');
#endif
  return path.substr(0, end == path.npos ? 0 : end + 1);
}

PALPATE_COLD PALPATE_INLINE std::string_view ending_of(std::string_view path) noexcept {
  const std::string_view name = path.substr(folder_of(path).size());
  const std::size_t dot = name.rfind('.');
  return dot == name.npos || dot == 0 || name == ".." ? std::string_view{} : name.substr(dot);
}

}}}  // namespace palpate::PALPATE_ABI::io
