#pragma once

namespace reliability {

/// Checks with synthetic reports that a failing extreme is reported as failing. Returns 0 on success.
int self_test();

}  // namespace reliability
