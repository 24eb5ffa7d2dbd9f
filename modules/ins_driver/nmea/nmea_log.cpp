// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/nmea/nmea_log.hpp"

#include <algorithm>
#include <array>

#include "modules/ins_driver/nmea/epoch_collector.hpp"
#include "modules/ins_driver/nmea/nmea_framer.hpp"
#include "modules/ins_driver/nmea/nmea_parser.hpp"

namespace tread::ins {
namespace {

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

/// The lines of a burst before it has its place in time.
struct RawBurst {
  std::string_view bytes;
  std::optional<int64_t> time_of_day;
};

/// Cuts a log where the time changes or where a sentence without a time comes again.
std::vector<RawBurst> cutIntoBursts(std::string_view log) {
  std::vector<RawBurst> bursts;
  std::array<bool, kSentenceTypes> seen{};
  size_t line_start = 0;
  while (line_start < log.size()) {
    const size_t newline = log.find('\n', line_start);
    const size_t line_end = newline == std::string_view::npos ? log.size() : newline + 1;
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
