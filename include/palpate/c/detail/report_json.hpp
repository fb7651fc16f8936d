// Reports as JSON.
#pragma once

#include <palpate/cut/cut_parameters.hpp>
#include <palpate/model/setup_report.hpp>

#include <optional>
#include <string>

namespace palpate { inline namespace PALPATE_ABI { namespace c_interface {

/// One object. Numbers that are not finite are null.
std::string to_json(const std::string& policy, const SetupReport& report, const std::optional<CutReport>& cuts);

}}}  // namespace palpate::PALPATE_ABI::c_interface
