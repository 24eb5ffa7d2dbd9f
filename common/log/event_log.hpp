// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "common/bus/channels.hpp"
#include "common/store/output_file.hpp"

namespace tread {

/// One event of an LCM log.
struct LogEvent {
  int64_t utime = 0;  ///< [us] time of recording by the recorder's clock: any value; from a
                      ///< DriveReader the robot's time
  std::string channel;
  std::vector<uint8_t> bytes;
  bool sealed = false;  ///< the logged message carried a seal; it was not verified
};

/// Whether a clock can show this time; other values are corrupt bytes.
constexpr bool isPossibleTime(int64_t utime) {
  constexpr int64_t kThreeCenturies = 10'000'000'000'000'000;  // [us]
  return utime > -kThreeCenturies && utime < kThreeCenturies;
}

/// A message as encoded for the bus.
template <class Message>
std::vector<uint8_t> encoded(const Message& message) {
  std::vector<uint8_t> bytes(static_cast<size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

/// The event of a message that was recorded at its own utime.
template <class Message>
LogEvent eventOf(const Channel<Message>& channel, const Message& message) {
  return {message.utime, channel.name, encoded(message)};
}

/// Writes LCM event logs that lcm-logplayer and lcm-spy read, as OutputFile does.
class LogWriter {
 public:
  explicit LogWriter(const std::string& path, OutputFile::Kind kind = OutputFile::Kind::kWhole);
  ~LogWriter();
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  /// Appends an event; throws WriteError when the disk is full.
  void write(int64_t utime, const std::string& channel, const uint8_t* bytes, size_t size);
  /// Flushes the buffer to the file.
  void flush();
  /// Moves the log to its final name. The destructor does so too, unless an exception is in flight,
  /// but cannot report errors.
  void close();

  /// Encodes and appends a message at its own utime.
  template <class Message>
  void write(const Channel<Message>& channel, const Message& message) {
    const std::vector<uint8_t> bytes = encoded(message);
    write(message.utime, channel.name, bytes.data(), bytes.size());
  }

 private:
  struct File;
  std::unique_ptr<File> file_;
};

/// Reads LCM event logs from front to back; reads the intact part of a damaged or truncated log and
/// reports the damage.
class LogReader {
 public:
  explicit LogReader(const std::string& path);
  ~LogReader();
  LogReader(const LogReader&) = delete;
  LogReader& operator=(const LogReader&) = delete;

  /// The next event, without its seal, and converted to today's type (see older_types.hpp); false
  /// at the end.
  bool next(LogEvent& event);
  /// Where the next event begins [bytes], for seek().
  uint64_t position() const;
  /// Goes to a position that position() returned.
  void seek(uint64_t position);
  /// One clear line if the log ends in the middle of an event or holds damaged bytes; empty if it
  /// is whole.
  const std::string& problem() const;

 private:
  struct File;
  std::unique_ptr<File> file_;
};

/// Decodes an event into a message; false if its channel or type is another, bytes are left over or
/// its time is impossible.
template <class Message>
bool decode(const LogEvent& event, const Channel<Message>& channel, Message& message) {
  if (event.channel != channel.name) return false;
  message = Message{};
  try {
    const int size = static_cast<int>(event.bytes.size());
    return message.decode(event.bytes.data(), 0, size) == size && isPossibleTime(message.utime);
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace tread
