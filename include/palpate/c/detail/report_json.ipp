// Definitions of report_json.hpp.
#pragma once

#include <palpate/c/detail/report_json.hpp>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <string_view>

namespace palpate { inline namespace PALPATE_ABI { namespace c_interface {

namespace {

/// Not called `quoted`: for a std::string the compiler would consider std::quoted, too.
std::string json_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      std::array<char, 8> code{};
      std::snprintf(code.data(), code.size(), "\\u%04x", static_cast<unsigned>(c));
      out += code.data();
    } else {
      out += c;
    }
  }
  return out += '"';
}

std::string json(double value) {
  if (!std::isfinite(value)) return "null";
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  return {digits.data(), end};
}
std::string json(bool value) {
  return value ? "true" : "false";
}
std::string json(Index value) {
  return std::to_string(value);
}
std::string json(int value) {
  return std::to_string(value);
}
std::string json(std::uint64_t value) {
  return std::to_string(value);
}
std::string json(const std::string& value) {
  return json_string(value);
}

/// Writes an object member by member.
class Object {
 public:
  template <class T>
  Object& add(const char* name, const T& value) {
    return raw(name, json(value));
  }
  Object& raw(const char* name, const std::string& value) {
    text_ += (text_.size() > 1 ? ", " : "") + json_string(name) + ": " + value;
    return *this;
  }
  std::string end() const { return text_ + "}"; }

 private:
  std::string text_ = "{";
};

std::string flag_name(SetupFlag flag) {
  switch (flag) {
    case SetupFlag::locking:
      return "locking";
    case SetupFlag::ill_conditioned:
      return "ill_conditioned";
    case SetupFlag::poor_quality:
      return "poor_quality";
    case SetupFlag::repaired:
      return "repaired";
    case SetupFlag::disconnected:
      return "disconnected";
    case SetupFlag::suspicious_units:
      return "suspicious_units";
    case SetupFlag::cache_rejected:
      return "cache_rejected";
    case SetupFlag::cache_unwritten:
      return "cache_unwritten";
    case SetupFlag::non_manifold:
      return "non_manifold";
    case SetupFlag::large_displacement:
      return "large_displacement";
    case SetupFlag::coarse_contact:
      return "coarse_contact";
    case SetupFlag::accuracy_not_reached:
      return "accuracy_not_reached";
    case SetupFlag::file_notes:
      return "file_notes";
    case SetupFlag::fixed_contact:
      return "fixed_contact";
  }
  return "unknown";
}

std::string accuracy(const AccuracyReport& r) {
  return Object()
      .add("radius", r.radius)
      .add("places", r.places)
      .add("pinched", r.pinched)
      .add("typical", r.typical)
      .add("largest", r.largest)
      .add("facet", r.facet)
      .add("remark", r.remark)
      .end();
}

std::string cuts_in_json(const CutReport& r) {
  return Object()
      .add("cuts", r.cuts)
      .add("renewals", r.renewals)
      .add("kept", r.kept)
      .add("error", r.error)
      .add("latency", r.latency)
      .add("failed", r.failed)
      .end();
}

}  // namespace

PALPATE_INLINE std::string to_json(const std::string& policy, const SetupReport& r,
                                   const std::optional<CutReport>& cuts) {
  Object seconds, flags;
  for (const auto& [stage, time] : r.seconds) seconds.add(stage.c_str(), time);
  for (const auto& [flag, remark] : r.remarks) flags.add(flag_name(flag).c_str(), remark);
  Object all;
  all.add("policy", policy)
      .add("nodes", r.nodes)
      .add("elements", r.elements)
      .add("free_dofs", r.free_dofs)
      .add("kept_dofs", r.kept_dofs)
      .add("condensed_dofs", r.condensed_dofs)
      .add("touchable_vertices", r.touchable_vertices)
      .add("rendered_nodes", r.rendered_nodes)
      .add("stiffness_bytes", static_cast<std::uint64_t>(r.stiffness_bytes))
      .add("solver_bytes", static_cast<std::uint64_t>(r.solver_bytes))
      .add("compliance_bytes", static_cast<std::uint64_t>(r.compliance_bytes))
      .add("worst_quality", r.worst_quality)
      .add("mean_quality", r.mean_quality)
      .add("condition_estimate", r.condition_estimate)
      .add("probe_error", r.probe_error)
      .add("asynchronous_columns", r.asynchronous_columns)
      .raw("seconds", seconds.end())
      .raw("accuracy", accuracy(r.accuracy))
      .raw("flags", flags.end());
  if (cuts) all.raw("cuts", cuts_in_json(*cuts));
  return all.end();
}

}}}  // namespace palpate::PALPATE_ABI::c_interface
