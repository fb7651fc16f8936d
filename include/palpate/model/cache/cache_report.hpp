// Report on the use of a cache file.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>

#include <iosfwd>
#include <ostream>
#include <string>

namespace palpate { inline namespace PALPATE_ABI {

/// The first reason found for not using a cache file.
enum class CacheMismatch : std::uint8_t {
  none,
  unreadable,   ///< it exists but cannot be opened
  foreign,      ///< not a cache file of palpate; never overwritten
  truncated,    ///< shorter than required
  byte_order,   ///< written on a machine of other endianness
  version,      ///< of the library or of the file's layout
  header,       ///< damaged: its own hash is wrong
  scalar,       ///< float, double
  policy,       ///< another solver
  element,      ///< other shape functions or quadrature
  mesh,         ///< positions, connectivity or regions
  material,     ///< elasticity; densities and loads do not matter
  conditions,   ///< which components are prescribed; their values do not matter
  touched,      ///< the touched nodes
  stiffness,    ///< all of the above agree, but the matrix differs: code or compiler changed
  elimination,  ///< another order of elimination: code or compiler changed
  payload,      ///< damaged: the hash of the stored numbers is wrong
  answers,      ///< everything matches, but a solve with a known solution is wrong
};

/// Result of a set-up with `cache_file`; `file` is empty when no cache was requested.
struct CacheReport {
  std::string file;
  bool supported = true;  ///< the solver has something to store
  bool read = false;      ///< the system was read from the file
  bool written = false;   ///< the file was (re)written
  CacheMismatch mismatch = CacheMismatch::none;
  std::string why;        ///< description of the differences, for `mismatch`
  std::string problem;    ///< why the file could not be written
  std::size_t bytes = 0;  ///< size of the file, read or written
};

/// One line: read / written / rebuilt because ... / could not be written because ...
std::ostream& operator<<(std::ostream& out, const CacheReport& r);

inline std::ostream& operator<<(std::ostream& out, const CacheReport& r) {
  const auto size = [&] { return " (" + number(static_cast<double>(r.bytes) / 1e6) + " MB)"; };
  if (!r.supported) return out << "this solver has nothing to store in " << r.file;
  if (r.read) return out << "read " << r.file << size();
  if (r.mismatch != CacheMismatch::none) out << "rebuilt because " << r.why << "; ";
  if (r.written) return out << "written " << r.file << size();
  return out << r.file << " could not be written because " << r.problem;
}

}}  // namespace palpate
