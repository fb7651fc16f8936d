// Assembles the stiffness of a body whose element type is known here only.
#pragma once

#include <palpate/assembly/detail/any_stiffness.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/model/detail/element_body.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

template <Element E, class Assembly>
AnyStiffness make_stiffness(const ElasticBody& body, const SetupLimits& limits) {
  return AnyStiffness(Assembly::make(element_body<E>(body).body(), limits));
}

}}}  // namespace palpate::detail
