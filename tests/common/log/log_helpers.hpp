// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "common/log/event_log.hpp"

namespace tread::testing {

/// A unique path; the file is removed at the end.
struct TemporaryFile {
  TemporaryFile() {
    static int count = 0;
    path = "/tmp/tread_log_" + std::to_string(::getpid()) + "_" + std::to_string(count++);
  }
  ~TemporaryFile() { std::remove(path.c_str()); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  std::string path;
};

inline std::string contentOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

inline void makeFile(const std::string& path, const std::string& content) {
  std::ofstream(path, std::ios::binary) << content;
}

/// Message i of a test log: i bytes, so that its length identifies it.
inline std::vector<uint8_t> messageOf(int i) {
  return std::vector<uint8_t>(static_cast<size_t>(i), static_cast<uint8_t>(i));
}

inline void writeEvents(const std::string& path, int count) {
  LogWriter writer(path);
  for (int i = 0; i < count; ++i) {
    const auto bytes = messageOf(i);
    writer.write(1000 * i, "CHANNEL", bytes.data(), bytes.size());
  }
}

/// Numbers of the events in a log, -1 for one that was never written.
inline std::vector<int> eventsOf(const std::string& path, std::string& problem) {
  std::vector<int> events;
  LogReader reader(path);
  LogEvent event;
  while (reader.next(event)) {
    const auto i = static_cast<int>(event.bytes.size());
    const bool same = event.bytes == messageOf(i) && event.utime == 1000 * i;
    events.push_back(same && event.channel == "CHANNEL" ? i : -1);
  }
  problem = reader.problem();
  return events;
}

}  // namespace tread::testing
