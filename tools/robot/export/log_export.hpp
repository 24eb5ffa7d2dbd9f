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

/// Writes an MCAP file: each channel as JSON with its JSON Schema and, if `scene` is set, the
/// drawings for Foxglove and Lichtblick (common/scene).
ExportCounts exportMcap(const std::vector<std::string>& logs, const Selection& selection,
                        const std::string& path, bool scene);

/// Writes one CSV file per channel: the time of recording by the robot's clock, one column per
/// number or text; an array of variable length is one column of JSON.
ExportCounts exportCsv(const std::vector<std::string>& logs, const Selection& selection,
                       const std::string& folder);

}  // namespace tread::exporting
