// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "common/drive/drive_reader.hpp"
#include "common/log/message_part.hpp"
#include "tools/robot/view/feed/history.hpp"

namespace tread::view {

/// Random access to a log by time.
class LogPlayer {
 public:
  using Take = std::function<void(const LogEvent&)>;

  /// Indexes the logs (parts of one recording, in order); throws std::runtime_error with one clear
  /// line if one cannot be read or is empty.
  explicit LogPlayer(const std::vector<std::string>& logs);

  int64_t begin() const { return entries_.front().utime; }  ///< [us] of the robot's clock
  int64_t end() const { return entries_.back().utime; }
  const std::string& problem() const { return problem_; }
  /// Events of the whole log.
  const History& history() const { return history_; }

  /// Jumps to a time and passes on what a viewer needs there: the newest message of each part that
  /// differs from the last one passed on.
  void seek(int64_t time, const Take& take);
  /// Advances to a later time and passes on the messages in between.
  void advance(int64_t time, const Take& take);
  int64_t now() const { return now_; }

 private:
  void tell(size_t entry, const Take& take);

  DriveReader reader_;
  std::vector<EventPlace> entries_;  ///< ordered by time
  /// Entries by channel and part, ascending.
  std::map<std::pair<std::string, uint64_t>, std::vector<size_t>> parts_;
  std::map<std::pair<std::string, uint64_t>, size_t> told_;  ///< entry passed on last
  History history_;
  std::string problem_;
  int64_t now_ = INT64_MIN;
  size_t next_ = 0;  ///< next entry
};

}  // namespace tread::view
