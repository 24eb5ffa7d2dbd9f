// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/robot/export/log_export.hpp"

namespace tread::exporting {

/// Decodes an event to JSON and counts it. nullopt, also counted, if the type is unknown or the
/// message damaged.
struct JsonMessage {
  const MessageType* type = nullptr;
  std::string json;
};
std::optional<JsonMessage> countedJson(const LogEvent& event, ExportCounts& counts);

/// Reads the selected events of several logs, which are parts of one recording in order.
class SelectedEvents {
 public:
  SelectedEvents(std::vector<std::string> logs, Selection selection)
      : logs_(std::move(logs)), selection_(std::move(selection)) {}

  /// Calls `take` for each event. Returns the damage of the logs in one line, empty if there is
  /// none. Throws std::runtime_error with one clear line if a log cannot be read.
  template <class Take>
  std::string forEach(const Take& take) {
    DriveReader log(logs_);
    for (DriveEvent event; log.next(event);)
      if (isWanted(event)) take(event);
    return log.problem();
  }

 private:
  bool isWanted(const LogEvent& event);

  std::vector<std::string> logs_;
  Selection selection_;
  int64_t begun_ = -1;  ///< [us]
};

}  // namespace tread::exporting
