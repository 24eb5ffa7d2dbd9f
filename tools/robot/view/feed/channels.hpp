// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace tread::view {

/// Topic of the events since the beginning and of a log's playback position.
inline constexpr const char* kHistoryTopic = "view/history";
inline constexpr const char* kPlayerTopic = "view/player";

/// A channel for viewers.
struct OfferedChannel {
  uint32_t id = 0;
  std::string topic;
  std::string schema_name;
  std::string schema;  ///< JSON Schema
};

/// Tread's channels, the scene's topics and the page's own.
class OfferedChannels {
 public:
  OfferedChannels();
  const std::vector<OfferedChannel>& all() const { return all_; }
  /// nullptr if there is none.
  const OfferedChannel* find(const std::string& topic) const;

 private:
  void add(const std::string& topic, const std::string& schema_name, const std::string& schema);

  std::vector<OfferedChannel> all_;
  std::map<std::string, size_t> by_topic_;
};

}  // namespace tread::view
