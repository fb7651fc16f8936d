#pragma once

namespace reliability {

/// Planted reports: does a failing extreme show as failing? 0 when all is as it must be.
int self_test();

}  // namespace reliability
