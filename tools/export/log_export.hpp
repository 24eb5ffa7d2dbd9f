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

#include "common/log/event_log.hpp"
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
  std::string problem;  ///< one clear line if the log is damaged; what is whole was exported
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

  /// Calls `take` for each; returns the logs' problem, empty if they are whole. Throws
  /// std::runtime_error with one clear line if a log cannot be read.
  template <class Take>
  std::string forEach(const Take& take) {
    std::string problem;
    for (const std::string& path : logs_) {
      LogReader log(path);
      LogEvent event;
      while (log.next(event))
        if (isWanted(event)) take(event);
      if (problem.empty()) problem = log.problem();
    }
    return problem;
  }

 private:
  bool isWanted(const LogEvent& event);

  std::vector<std::string> logs_;
  Selection selection_;
  int64_t begun_ = -1;  ///< [us] by the recorder
};

/// Writes an MCAP file: each channel as JSON with its type as JSON Schema, and beside them what
/// Foxglove and Lichtblick draw by themselves (see common/scene), unless `scene` is off.
ExportCounts exportMcap(const std::vector<std::string>& logs, const Selection& selection,
                        const std::string& path, bool scene);

/// Writes a CSV file for each channel into a folder: a column for each number and text, an array of
/// varying length as JSON in one column.
ExportCounts exportCsv(const std::vector<std::string>& logs, const Selection& selection,
                       const std::string& folder);

}  // namespace tread::exporting
