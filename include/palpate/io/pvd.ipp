// Definitions of pvd.hpp.
#pragma once

#include <palpate/io/decimal.hpp>
#include <palpate/io/detail/message.hpp>
#include <palpate/io/pvd.hpp>

#include <bit>
#include <cmath>
#include <filesystem>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

PALPATE_INLINE PvdSeries::PvdSeries(const std::string& path) : path_(path), stream_(std::fopen(path.c_str(), "wb")) {
  if (!stream_) refuse(SetupErrorKind::bad_file, {path_, ": cannot be opened for writing"});
  std::fgetpos(stream_.get(), &end_);
  put(joined({"<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"",
              std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian", "\">\n  <Collection>\n"}));
}

PALPATE_INLINE void PvdSeries::add(double time, const std::string& file) {
  if (!std::isfinite(time)) refuse(SetupErrorKind::non_finite, {"the time of '", file, "' is not finite"});
  const auto folder = std::filesystem::path(path_).parent_path();
  const std::string entry = std::filesystem::path(file).lexically_proximate(folder).generic_string();
  put(joined({"    <DataSet timestep=\"", to_decimal(time), "\" part=\"0\" file=\"", vtk::escape(entry), "\"/>\n"}));
  ++size_;
}

PALPATE_INLINE void PvdSeries::put(const std::string& text) {
  std::FILE* stream = stream_.get();
  constexpr std::string_view closing = "  </Collection>\n</VTKFile>\n";
  const bool is_written =
      std::fsetpos(stream, &end_) == 0 && std::fwrite(text.data(), 1, text.size(), stream) == text.size() &&
      std::fgetpos(stream, &end_) == 0 && std::fwrite(closing.data(), 1, closing.size(), stream) == closing.size() &&
      std::fflush(stream) == 0;
  if (!is_written) refuse(SetupErrorKind::bad_file, {path_, ": writing failed"});
}

}}}  // namespace palpate::PALPATE_ABI::io
