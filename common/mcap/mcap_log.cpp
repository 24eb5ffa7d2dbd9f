// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/mcap/mcap_log.hpp"

#include <stdexcept>

#include "common/mcap/mcap_reader.hpp"
#include "common/types/message_json.hpp"
#include "common/types/tread_types.hpp"

namespace tread::mcap {
namespace {

/// Whether a number is a date of this century [us].
bool isDate(uint64_t us) {
  return us > 1'200'000'000'000'000 && us < 2'200'000'000'000'000;
}

/// MCAP log times are in ns, Tread's own times in us; rejects files that mix them up.
void requireTimeUnits(const std::string& path, const Message& message,
                      const std::vector<uint8_t>& bytes) {
  constexpr size_t kUtime = 8;  // [bytes] behind the type's fingerprint
  uint64_t utime = 0;
  for (size_t i = kUtime; i < kUtime + 8 && i < bytes.size(); ++i) utime = (utime << 8U) | bytes[i];
  if (isDate(utime) && isDate(message.log_time))
    throw std::runtime_error(path + ": its log times are in us; MCAP counts them in ns");
  if (isDate(utime / 1000) && isDate(message.log_time / 1000))
    throw std::runtime_error(path + ": utime of " + message.topic + " is in ns; it counts us");
}

}  // namespace

McapCounts writeLog(const std::string& path, LogWriter& log) {
  Reader reader(path);
  Message message;
  McapCounts counts;
  while (reader.next(message)) {
    const MessageType* const type = typeOfChannel(message.topic);
    if (type == nullptr || message.schema_name != "tread." + type->name ||
        message.encoding != "json") {
      ++counts.left_out[message.topic + ": another type"];
      continue;
    }
    try {
      const std::vector<uint8_t> bytes = bytesOf(treadTypes(), *type, message.data);
      requireTimeUnits(path, message, bytes);
      log.write(static_cast<int64_t>(message.log_time / 1000), message.topic, bytes.data(),
                bytes.size());
      ++counts.taken;
    } catch (const std::invalid_argument& error) {
      ++counts.lost[message.topic + ": " + error.what()];
    }
  }
  counts.problem = reader.problem();
  counts.lost_bytes = reader.lostBytes();
  counts.bytes = reader.size();
  counts.cut_off = reader.cutOff();
  if (reader.lostMessages() > 0)
    counts.lost["damaged"] = static_cast<int64_t>(reader.lostMessages());
  if (counts.taken == 0)
    throw std::runtime_error(path + ": holds no message of Tread; was it made by tread-export?" +
                             (counts.problem.empty() ? "" : " (" + counts.problem + ")"));
  return counts;
}

}  // namespace tread::mcap
