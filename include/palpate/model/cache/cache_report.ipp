// Definitions of cache_report.hpp.
#pragma once

#include <palpate/model/cache/cache_report.hpp>
#include <palpate/core/setup_error.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE std::ostream& operator<<(std::ostream& out, const CacheReport& r) {
  const auto size = [&] { return " (" + number(static_cast<double>(r.bytes) / 1e6) + " MB)"; };
  if (!r.supported) return out << "this solver has nothing to store in " << r.file;
  if (r.read) return out << "read " << r.file << size();
  if (r.mismatch != CacheMismatch::none) out << "rebuilt because " << r.why << "; ";
  if (r.written) return out << "written " << r.file << size();
  return out << r.file << " could not be written because " << r.problem;
}

}}  // namespace palpate
