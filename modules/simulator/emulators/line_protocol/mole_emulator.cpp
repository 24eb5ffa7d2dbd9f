// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/emulators/line_protocol/mole_emulator.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "common/report/text.hpp"

namespace tread::sim {
namespace {

constexpr int kFull = 32000;
constexpr size_t kLongest = 80;

/// Bit by bit over the line's body: x^16 + x^12 + x^5 + 1, from 0.
unsigned remainderOf(const std::string& body) {
  unsigned rest = 0;
  for (size_t i = 1; i < body.size(); ++i) {
    for (int bit = 7; bit >= 0; --bit) {
      const unsigned in = (static_cast<unsigned char>(body[i]) >> bit) & 1U;
      const bool out = ((rest >> 15) ^ in) != 0;
      rest = (rest << 1) & 0xffffU;
      if (out) rest ^= 0x1021U;
    }
  }
  return rest;
}

int signed16(unsigned word) {
  return static_cast<int16_t>(word);
}

}  // namespace

std::string MoleEmulator::framed(const std::string& body) {
  return body + formatted("*%04X\n", remainderOf(body));
}

std::array<double, 2> MoleEmulator::output(int64_t utime) {
  advance(utime);
  if (expired_ || locked_ || faults_ != 0) return {0.0, 0.0};
  return {power_[0] / static_cast<double>(kFull), power_[1] / static_cast<double>(kFull)};
}

void MoleEmulator::run(int64_t utime) {
  if (static_cast<double>(utime - fed_) >= 1e6 * watchdog_) expired_ = true;
}

void MoleEmulator::powerUp(int64_t utime) {
  line_.clear();
  power_ = {0, 0};
  watchdog_ = 1.0;
  expired_ = true;
  locked_ = false;
  say(framed("$BOOT"), utime);
}

void MoleEmulator::hear(char byte, int64_t utime) {
  if (byte != '\n') {
    if (byte >= ' ' && line_.size() < kLongest) line_ += byte;
    return;
  }
  const std::string line = std::exchange(line_, {});
  const size_t star = line.rfind('*');
  if (star == std::string::npos || line[0] != '$') return;
  const std::string body = line.substr(0, star);
  if (framed(body) != line + "\n") return;
  reply(framed(answer(body, utime)), utime);
}

std::string MoleEmulator::answer(const std::string& body, int64_t utime) {
  unsigned left = 0;
  unsigned right = 0;
  if (std::sscanf(body.c_str(), "$DRV,%4x,%4x", &left, &right) == 2)
    return drive(signed16(left), signed16(right), utime);
  if (body == "$HLT") return drive(0, 0, utime);
  if (body == "$WDT?") return formatted("$WDT,%.2f", watchdog_);
  if (body.rfind("$WDT,", 0) == 0) return setWatchdog(body.substr(5));
  if (body == "$STA") return status();
  if (body == "$TEL") return telemetry();
  if (body != "$LCK" && body != "$ULK") return "$ERR,unknown";
  locked_ = body == "$LCK";
  if (!locked_) {
    expired_ = false;
    fed_ = utime;
  }
  return "$OK";
}

std::string MoleEmulator::drive(int left, int right, int64_t utime) {
  if (std::abs(left) > kFull || std::abs(right) > kFull) return "$ERR,range";
  const bool moves = left != 0 || right != 0;
  if (locked_ && moves) return "$ERR,locked";
  resumed_ += expired_ && moves;
  power_ = {left, right};
  expired_ = false;
  fed_ = utime;
  return "$OK";
}

std::string MoleEmulator::setWatchdog(const std::string& text) {
  const double seconds = std::atof(text.c_str());
  if (seconds < 0.05 || seconds > 5.0) return "$ERR,range";
  watchdog_ = seconds;
  return "$OK";
}

std::string MoleEmulator::status() const {
  return formatted("$STA,%02x,%.2f,%+d", (locked_ ? 1 : 0) | faults_, measurements_.battery_voltage,
                   31);
}

std::string MoleEmulator::telemetry() const {
  return formatted("$TEL,%+.1f,%+.1f,%+ld,%+ld", measurements_.motor_current[0],
                   measurements_.motor_current[1], std::lround(1000 * measurements_.track_speed[0]),
                   std::lround(1000 * measurements_.track_speed[1]));
}

}  // namespace tread::sim
