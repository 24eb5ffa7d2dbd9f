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

/// A log that can be looked at any time of it.
class LogPlayer {
 public:
  using Take = std::function<void(const LogEvent&)>;

  /// Reads through the logs (parts of one recording, in order) once; throws std::runtime_error with
  /// one clear line if one cannot be read or holds nothing.
  explicit LogPlayer(const std::vector<std::string>& logs);

  int64_t begin() const { return entries_.front().utime; }  ///< [us] of the robot's clock
  int64_t end() const { return entries_.back().utime; }
  const std::string& problem() const { return problem_; }
  /// What happened in the whole log.
  const History& history() const { return history_; }

  /// Goes to a time and tells what a viewer must know there: the newest message of each part that
  /// differs from what was told before.
  void seek(int64_t time, const Take& take);
  /// Goes on to a later time and tells what came meanwhile.
  void advance(int64_t time, const Take& take);
  int64_t now() const { return now_; }

 private:
  void tell(size_t entry, const Take& take);

  DriveReader reader_;
  std::vector<EventPlace> entries_;  ///< in the order of time
  /// By channel and part: which entries there are, ascending.
  std::map<std::pair<std::string, uint64_t>, std::vector<size_t>> parts_;
  std::map<std::pair<std::string, uint64_t>, size_t> told_;  ///< the entry told last
  History history_;
  std::string problem_;
  int64_t now_ = INT64_MIN;
  size_t next_ = 0;  ///< entry that comes next
};

}  // namespace tread::view
