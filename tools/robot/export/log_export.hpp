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

/// What of a log is wanted.
struct Selection {
  std::set<std::string> channels;  ///< empty = all
  double from = 0.0;               ///< [s] since the log began
  double to = std::numeric_limits<double>::infinity();
};

/// What became of the messages.
struct ExportCounts {
  std::map<std::string, int64_t> written;   ///< messages by channel
  std::map<std::string, int64_t> left_out;  ///< by what they are: of another type, broken
  std::string problem;  ///< one clear line of what is wrong with the log; the rest was exported
};

/// The event's message as JSON, counted; nothing, counted too, if it is none of Tread's.
struct JsonMessage {
  const MessageType* type = nullptr;
  std::string json;
};
std::optional<JsonMessage> countedJson(const LogEvent& event, ExportCounts& counts);

/// Reads the events of logs (parts of one recording, in order) that are wanted.
class SelectedEvents {
 public:
  SelectedEvents(std::vector<std::string> logs, Selection selection)
      : logs_(std::move(logs)), selection_(std::move(selection)) {}

  /// Calls `take` for each; returns the logs' problem, empty if nothing is wrong. Throws
  /// std::runtime_error with one clear line if a log cannot be read.
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

/// Writes an MCAP file: each channel as JSON with its type as JSON Schema, and beside them what
/// Foxglove and Lichtblick draw by themselves (see common/scene), unless `scene` is off.
ExportCounts exportMcap(const std::vector<std::string>& logs, const Selection& selection,
                        const std::string& path, bool scene);

/// Writes a CSV file for each channel into a folder: when it was recorded, by the robot's clock; a
/// column for each number and text, an array of varying length as JSON in one column.
ExportCounts exportCsv(const std::vector<std::string>& logs, const Selection& selection,
                       const std::string& folder);

}  // namespace tread::exporting
