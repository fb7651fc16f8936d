// Checks that a call is refused, and with which problem.
#pragma once

#include <palpate/core/setup_error.hpp>

#include <functional>

#include "catch.hpp"

namespace test {

/// Calls `what`, which must throw a SetupError, and returns its problem.
inline palpate::SetupProblem refusal(const std::function<void()>& what) {
  try {
    what();
  } catch (const palpate::SetupError& error) {
    return error.problem();
  }
  FAIL_CHECK("accepted, but must be refused");
  return {};
}

/// Calls `what` and returns the kind of its SetupError as text, "accepted" when it throws none.
inline std::string refusal_kind(const std::function<void()>& what) {
  try {
    what();
  } catch (const palpate::SetupError& error) {
    return std::string(palpate::to_string(error.kind()));
  }
  return "accepted";
}

}  // namespace test

#define CHECK_REFUSED(expected, ...) CHECK(test::refusal_kind([&] { __VA_ARGS__; }) == palpate::to_string(expected))
