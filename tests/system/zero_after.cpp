// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/system/zero_after.hpp"

#include <algorithm>

namespace tread::testing {

std::optional<int64_t> zeroAfter(const std::vector<sim::TruthRow>& rows, int64_t utime,
                                 int64_t hold) {
  int64_t zero = -1;
  for (const sim::TruthRow& row : rows) {
    if (!row.motorsAtZero()) zero = -1;
    if (row.motorsAtZero() && zero < 0) zero = row.utime;
    if (zero >= 0 && row.utime >= utime + hold && row.utime - zero >= hold)
      return std::max(zero, utime);
  }
  return std::nullopt;
}

}  // namespace tread::testing
