// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/emulators/line_protocol/mole_emulator.hpp"

#include <algorithm>
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

/// The words of up to four hexadecimal digits after "$DRV," as signed numbers.
std::vector<int> wordsIn(const std::string& body) {
  std::vector<int> words;
  for (const char* at = body.c_str() + 4; *at == ',';) {
    unsigned word = 0;
    int length = 0;
    if (std::sscanf(++at, "%4x%n", &word, &length) != 1) break;
    words.push_back(static_cast<int16_t>(word));
    at += length;
  }
  return words;
}

}  // namespace

std::string MoleEmulator::framed(const std::string& body) {
  return body + formatted("*%04X\n", remainderOf(body));
}

MotorValues MoleEmulator::output(int64_t utime) {
  advance(utime);
  MotorValues output{};
  if (expired_ || locked_ || faults_ != 0) return output;
  for (size_t i = 0; i < power_.size(); ++i) output[i] = power_[i] / static_cast<double>(kFull);
  return output;
}

void MoleEmulator::run(int64_t utime) {
  if (static_cast<double>(utime - fed_) >= 1e6 * watchdog_) expired_ = true;
}

void MoleEmulator::powerUp(int64_t utime) {
  line_.clear();
  std::fill(power_.begin(), power_.end(), 0);
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
  if (body.rfind("$DRV,", 0) == 0) {
    const std::vector<int> power = wordsIn(body);
    if (power.size() == power_.size()) return drive(power, utime);
  }
  if (body == "$HLT") return drive(std::vector<int>(power_.size(), 0), utime);
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

std::string MoleEmulator::drive(const std::vector<int>& power, int64_t utime) {
  const auto any = [&power](auto is) { return std::any_of(power.begin(), power.end(), is); };
  if (any([](int word) { return std::abs(word) > kFull; })) return "$ERR,range";
  const bool moves = any([](int word) { return word != 0; });
  if (locked_ && moves) return "$ERR,locked";
  resumed_ += expired_ && moves;
  power_ = power;
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
  std::string body = "$TEL";
  for (size_t i = 0; i < power_.size(); ++i)
    body += formatted(",%+.1f", measurements_.motor_current[i]);
  for (size_t i = 0; i < power_.size(); ++i)
    body += formatted(",%+ld", std::lround(1000 * measurements_.track_speed[i]));
  return body;
}

}  // namespace tread::sim
