// What is refused, and how.
#pragma once

#include <palpate/core/setup_error.hpp>

#include <functional>

#include "catch.hpp"

namespace test {

/// The problem with which `what` is refused.
inline palpate::SetupProblem refusal(const std::function<void()>& what) {
  try {
    what();
  } catch (const palpate::SetupError& error) {
    return error.problem();
  }
  FAIL_CHECK("accepted, and must not be");
  return {};
}

/// The kind as a word, "accepted" when nothing is refused.
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
