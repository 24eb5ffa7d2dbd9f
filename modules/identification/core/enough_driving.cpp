// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/enough_driving.hpp"

#include <algorithm>
#include <cstdio>

#include "modules/identification/core/validation.hpp"

namespace tread::gap {

int measuredBlocks(const Rows& rows) {
  const std::vector<char> counts = blocksThatCount(rows, std::vector<char>(rows.rows().size(), 1));
  return static_cast<int>(std::count(counts.begin(), counts.end(), char{1}));
}

std::string tooLittleDriving(const Rows& rows) {
  const int measured = measuredBlocks(rows);
  if (measured >= kLeastBlocks) return "";
  double driven = 0.0;
  for (const Drive& drive : rows.drives()) driven += drive.driven();
  if (rows.blocks() > measured && rows.blockLength() > 0.0) driven = measured * rows.blockLength();
  char text[200];
  std::snprintf(text, sizeof text,
                "only %.0f s of measured driving, too little to tell chance from cause: drive at "
                "least %.0f s",
                driven, kLeastBlocks * RowSettings{}.block);
  return text;
}

}  // namespace tread::gap
