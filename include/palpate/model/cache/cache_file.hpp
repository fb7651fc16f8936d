// The option that stores the prepared system of a static model in a file for the next set-up.
#pragma once

#include <palpate/core/config.hpp>

#include <concepts>
#include <string>
#include <type_traits>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

struct SetupReport;
class CacheFile;
namespace detail {

class AnyStaticSystem;
struct SystemSource;

/// The system of a source, read from the file, or computed and stored in it. Throws the errors of SystemSource::make; a
/// file that is invalid or cannot be written is reported and is not an error.
AnyStaticSystem prepare_with_cache(const SystemSource& source, const std::string& file, SetupReport& report);

}  // namespace detail

/// The name of a cache file, or none (docs/cache.md). Made from any string. By default there is no file, and nothing of
/// it is compiled: a name brings a pointer to the code that reads and writes the file. Copies keep both.
class CacheFile {
 public:
  /// No file.
  CacheFile() = default;
  /// A file of this name; an empty name is no file.
  template <class Name>
  requires(!std::same_as<std::remove_cvref_t<Name>, CacheFile> && std::constructible_from<std::string, Name>)
      CacheFile(Name&& name)  // NOLINT(google-explicit-constructor)
      : name_(std::forward<Name>(name)), prepare_(&detail::prepare_with_cache) {}

  bool empty() const noexcept { return name_.empty(); }
  const std::string& name() const noexcept { return name_; }
  operator const std::string&() const noexcept { return name_; }  // NOLINT(google-explicit-constructor)

  /// The system of a source by way of this file, which must not be empty. For set-up.
  detail::AnyStaticSystem prepare(const detail::SystemSource& source, SetupReport& report) const;

 private:
  using Prepare = detail::AnyStaticSystem (*)(const detail::SystemSource&, const std::string&, SetupReport&);

  std::string name_;
  Prepare prepare_ = nullptr;  // null only without a name
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/cache/cache_file.ipp>
#endif
