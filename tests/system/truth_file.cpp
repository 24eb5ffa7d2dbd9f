// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/system/truth_file.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>

namespace tread::testing {

std::vector<TruthRow> readTruth(const std::string& path) {
  std::vector<TruthRow> rows;
  std::ifstream file(path);
  std::string line;
  while (std::getline(file, line)) {
    if (file.eof()) break;  // the last one may be half written
    TruthRow row;
    long long utime = 0;
    char surface[32];
    const int count =
        std::sscanf(line.c_str(), "%lld,%lf,%lf,%lf,%lf,%lf,%lf,%31[^,],%d", &utime, &row.x, &row.y,
                    &row.yaw, &row.speed, &row.left, &row.right, surface, &row.contacts);
    if (count != 9) continue;
    row.utime = utime;
    rows.push_back(row);
  }
  return rows;
}

std::optional<int64_t> zeroAfter(const std::vector<TruthRow>& rows, int64_t utime, int64_t hold) {
  int64_t zero = -1;
  for (const TruthRow& row : rows) {
    if (!row.motorsAtZero()) zero = -1;
    if (row.motorsAtZero() && zero < 0) zero = row.utime;
    if (zero >= 0 && row.utime >= utime + hold && row.utime - zero >= hold)
      return std::max(zero, utime);
  }
  return std::nullopt;
}

}  // namespace tread::testing
