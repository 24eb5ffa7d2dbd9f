// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/nmea/nmea_framer.hpp"

#include <algorithm>
#include <array>

#include "modules/ins_driver/core/device_clock.hpp"

namespace tread::ins {
namespace {

/// '$', CR and LF.
constexpr size_t kFraming = 3;

/// Value of a hexadecimal digit, or -1.
int hexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

bool printable(char c) {
  return c >= 0x20 && c <= 0x7E;
}

constexpr int64_t kUntimedUs = 100'000;
constexpr int64_t kMaxPauseUs = 60'000'000;

/// The sentence of a line, if it is a good one.
std::optional<NmeaSentence> sentenceOf(std::string_view line) {
  NmeaFramer framer;
  for (const char byte : line) {
    const std::optional<std::string_view> body = framer.push(byte);
    if (!body) continue;
    const ParseResult result = parseNmea(*body);
    if (const auto* sentence = std::get_if<NmeaSentence>(&result)) return *sentence;
    return std::nullopt;
  }
  return std::nullopt;
}

/// The lines of a burst before its time is known.
struct RawBurst {
  std::string_view bytes;
  std::optional<int64_t> time_of_day;
};

/// Splits a log where the time changes or where a sentence without a time repeats.
std::vector<RawBurst> cutIntoBursts(std::string_view log) {
  std::vector<RawBurst> bursts;
  std::array<bool, kSentenceTypes> seen{};
  size_t line_start = 0;
  while (line_start < log.size()) {
    const size_t end = log.find_first_of("\r\n", line_start);
    const bool both = end != std::string_view::npos && log.substr(end, 2) == "\r\n";
    const size_t line_end = end == std::string_view::npos ? log.size() : end + (both ? 2 : 1);
    const std::string_view line = log.substr(line_start, line_end - line_start);
    const std::optional<NmeaSentence> sentence = sentenceOf(line);
    const auto time_of_day = sentence ? timeOfDay(*sentence) : std::nullopt;
    const auto burst_time = bursts.empty() ? std::nullopt : bursts.back().time_of_day;
    const bool another_time = time_of_day && burst_time && *time_of_day != *burst_time;
    const bool again = sentence && !time_of_day && seen[sentence->index()];
    if (bursts.empty() || another_time || again) {
      bursts.push_back({log.substr(line_start, 0), {}});
      seen = {};
    }
    RawBurst& burst = bursts.back();
    burst.bytes = {burst.bytes.data(), burst.bytes.size() + line.size()};
    if (sentence) seen[sentence->index()] = true;
    if (time_of_day) burst.time_of_day = time_of_day;
    line_start = line_end;
  }
  return bursts;
}

}  // namespace

uint8_t nmeaChecksum(std::string_view body) {
  uint8_t sum = 0;
  for (const char c : body) sum = static_cast<uint8_t>(sum ^ static_cast<uint8_t>(c));
  return sum;
}

std::optional<std::string_view> NmeaFramer::push(char byte) {
  if (byte == '$') {
    interrupt();
    inside_ = true;
    line_.clear();
    ++sentences_;
    return std::nullopt;
  }
  const bool line_end = byte == '\r' || byte == '\n';
  if (!inside_) {
    if (!line_end) ++stray_bytes_;
    return std::nullopt;
  }
  if (line_end) return endOfLine();
  if (!printable(byte)) {
    refuse(SentenceRefusal::kNotPrintable);
  } else if (line_.size() + kFraming >= kMaxLength) {
    refuse(SentenceRefusal::kTooLong);
  } else {
    line_.push_back(byte);
  }
  return std::nullopt;
}

void NmeaFramer::interrupt() {
  if (inside_) refuse(SentenceRefusal::kCut);
}

void NmeaFramer::refuse(SentenceRefusal reason) {
  refusals_.add(reason);
  inside_ = false;
}

std::optional<std::string_view> NmeaFramer::endOfLine() {
  const std::string_view line = line_;
  const size_t star = line.find('*');
  const bool at_its_place = star != std::string_view::npos && star + 3 == line.size();
  const int high = at_its_place ? hexDigit(line[star + 1]) : -1;
  const int low = at_its_place ? hexDigit(line[star + 2]) : -1;
  if (high < 0 || low < 0) {
    refuse(SentenceRefusal::kNoChecksum);
    return std::nullopt;
  }
  const std::string_view body = line.substr(0, star);
  if (nmeaChecksum(body) != high * 16 + low) {
    refuse(SentenceRefusal::kWrongChecksum);
    return std::nullopt;
  }
  inside_ = false;
  return body;
}

std::vector<NmeaBurst> scheduleNmeaLog(std::string_view log) {
  const std::vector<RawBurst> raw = cutIntoBursts(log);
  std::vector<NmeaBurst> bursts;
  DeviceClock clock;
  size_t untimed = 0;  // bursts since the last one with a time
  int64_t utime = 0;
  for (size_t i = 0; i < raw.size(); ++i) {
    ++untimed;
    const bool last = i + 1 == raw.size();
    if (!raw[i].time_of_day && !last) continue;
    int64_t span = kUntimedUs * static_cast<int64_t>(untimed);
    if (raw[i].time_of_day) {
      const int64_t device_time = clock.timeOf(*raw[i].time_of_day);
      const int64_t pause = clock.newest() ? device_time - *clock.newest() : 0;
      if (pause > 0) span = std::min(pause, kMaxPauseUs);
      clock.accept(device_time);
    }
    for (size_t k = 1; k <= untimed; ++k) {
      const int64_t share = span * static_cast<int64_t>(k) / static_cast<int64_t>(untimed);
      bursts.push_back({utime + share, raw[i + k - untimed].bytes});
    }
    utime += span;
    untimed = 0;
  }
  return bursts;
}

}  // namespace tread::ins
