// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/mcap/mcap_log.hpp"

#include <stdexcept>

#include "common/mcap/mcap_reader.hpp"
#include "common/types/message_json.hpp"

namespace tread::mcap {

LogCounts writeLog(const std::string& path, LogWriter& log) {
  Reader reader(path);
  Message message;
  LogCounts counts;
  while (reader.next(message)) {
    const MessageType* const type = typeOfChannel(message.topic);
    if (type == nullptr || message.schema_name != "tread." + type->name ||
        message.encoding != "json") {
      ++counts.left_out[message.topic + ": another type"];
      continue;
    }
    try {
      const std::vector<uint8_t> bytes = bytesOf(treadTypes(), *type, message.data);
      log.write(static_cast<int64_t>(message.log_time / 1000), message.topic, bytes.data(),
                bytes.size());
      ++counts.taken;
    } catch (const std::invalid_argument& error) {
      ++counts.left_out[message.topic + ": " + error.what()];
    }
  }
  counts.problem = reader.problem();
  if (counts.taken == 0)
    throw std::runtime_error(path + ": holds no message of Tread; was it made by tread-export?" +
                             (counts.problem.empty() ? "" : " (" + counts.problem + ")"));
  return counts;
}

}  // namespace tread::mcap
