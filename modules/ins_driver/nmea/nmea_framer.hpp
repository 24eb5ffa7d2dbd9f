// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "modules/ins_driver/nmea/nmea_parser.hpp"

namespace tread::ins {

/// Splits a byte stream into NMEA 0183 sentences and passes only those with a correct checksum.
/** A sentence is '$', printable characters, '*', two hexadecimal digits, CR or LF. Every '$'
 * restarts it, so that no input, however long or strange, makes the framer miss the next good
 * line. */
class NmeaFramer {
 public:
  /// The standard allows 82 characters with '$' and line end; devices with many decimals need more.
  static constexpr size_t kMaxLength = 128;

  /// Takes one byte. If it completes a good sentence: the text between '$' and '*', valid until the
  /// next call.
  std::optional<std::string_view> push(char byte);

  /// Whether the last byte was the '$' that starts a sentence.
  bool justStarted() const { return inside_ && line_.empty(); }

  /// Starts seen: good sentences + refused ones + at most one incomplete one.
  int64_t sentences() const { return sentences_; }
  /// Bytes outside of sentences, not counting line ends.
  int64_t strayBytes() const { return stray_bytes_; }
  const SentenceRefusals& refusals() const { return refusals_; }

  /// Discards an incomplete sentence: the link was closed, or the log has ended. It counts as cut
  /// short.
  void interrupt();

 private:
  void refuse(SentenceRefusal reason);
  std::optional<std::string_view> endOfLine();

  std::string line_;  ///< text after '$'
  bool inside_ = false;
  int64_t sentences_ = 0;
  int64_t stray_bytes_ = 0;
  SentenceRefusals refusals_;
};

/// Exclusive-or of all characters: the NMEA 0183 checksum of the text between '$' and '*'.
uint8_t nmeaChecksum(std::string_view body);

/// Lines of a recorded log that the device sent together.
struct NmeaBurst {
  int64_t utime = 0;       ///< when to replay it, since the start of the log [us]
  std::string_view bytes;  ///< part of the log
};

/// Reconstructs the timing of a recorded log from the UTC in its sentences.
/** A burst starts where the time changes or where a sentence without a time repeats. Bursts without
 * any time share the span to the next one that has it. Without such a span, or if time goes back,
 * a burst follows 100 ms after the previous one; pauses are cut to 60 s. The bytes of the bursts
 * together are the log. */
std::vector<NmeaBurst> scheduleNmeaLog(std::string_view log);

}  // namespace tread::ins
