// Reads and writes whole files, and splits their names.
#pragma once

#include <palpate/core/config.hpp>

#include <initializer_list>
#include <string>
#include <string_view>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// The whole of a file. Throws bad_file if it cannot be read or is a folder.
std::string read_file(const std::string& path);

/// Writes the parts in sequence to a file, replacing it. Throws bad_file.
void write_file(const std::string& path, std::initializer_list<std::string_view> parts);

/// Whether there is a file or folder of that name.
bool is_there(const std::string& path);

/// Whether there is a file of that name, not a folder or device.
bool is_regular_file(const std::string& path);

/// The extension of a file's name with its dot; empty if it has none. ".x" has none.
std::string_view ending_of(std::string_view path) noexcept;

/// The part of a path before the file's name, with the separator; empty for a name without a folder.
std::string_view folder_of(std::string_view path) noexcept;

}}}  // namespace palpate::PALPATE_ABI::io

#if PALPATE_HEADER_ONLY
#include <palpate/io/file.ipp>
#endif
