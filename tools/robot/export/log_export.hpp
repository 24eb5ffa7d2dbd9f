// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/drive/drive_reader.hpp"
#include "common/types/message_type.hpp"

namespace tread::exporting {

/// Which part of a log to export.
struct Selection {
  std::set<std::string> channels;  ///< empty = all
  double from = 0.0;               ///< [s] since the log began
  double to = std::numeric_limits<double>::infinity();
};

/// Counts of exported and skipped messages.
struct ExportCounts {
  std::map<std::string, int64_t> written;   ///< messages by channel
  std::map<std::string, int64_t> left_out;  ///< by reason: foreign type, damaged
  std::string problem;  ///< damage of the log in one line; the rest was exported
};

}  // namespace tread::exporting
