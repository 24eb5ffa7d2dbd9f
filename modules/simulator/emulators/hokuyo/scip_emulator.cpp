// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/emulators/hokuyo/scip_emulator.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tread::sim {
namespace {

constexpr size_t kLineLength = 64;      // of measured values, without sum
constexpr size_t kLongestCommand = 80;  // longer ones are discarded
constexpr uint32_t kNothingHit = 65533;
constexpr uint32_t kMostOfTwo = 4095;  // of two characters
constexpr uint32_t kNoMeasurement = 1;

std::optional<int> digits(const std::string& text, size_t from, size_t count) {
  if (text.size() < from + count) return std::nullopt;
  int value = 0;
  for (size_t i = from; i < from + count; ++i) {
    if (text[i] < '0' || text[i] > '9') return std::nullopt;
    value = 10 * value + (text[i] - '0');
  }
  return value;
}

std::string twoDigits(int value) {
  return {static_cast<char>('0' + value / 10), static_cast<char>('0' + value % 10)};
}

/// Device time of a scan: milliseconds, 24 bits.
uint32_t deviceTime(int64_t utime) {
  return static_cast<uint32_t>(utime / 1000) & 0xFFFFFFu;
}

}  // namespace

char scipSum(std::string_view bytes) {
  unsigned sum = 0;
  for (char byte : bytes) sum += static_cast<unsigned char>(byte);
  return static_cast<char>((sum & 0x3F) + 0x30);
}

std::string scipEncode(uint32_t value, int characters) {
  std::string text(static_cast<size_t>(characters), '0');
  for (size_t i = text.size(); i-- > 0; value >>= 6)
    text[i] = static_cast<char>((value & 0x3F) + 0x30);
  return text;
}

ScipSettings scipSettingsOf(const LaserParameters& laser) {
  ScipSettings settings;
  settings.range_min_mm = static_cast<int>(std::lround(1000.0 * laser.range_min));
  settings.range_max_mm = static_cast<int>(std::lround(1000.0 * laser.range_max));
  settings.last_step = laser.beams - 1;
  settings.front_step = (laser.beams - 1) / 2;
  const double step = laser.field_of_view / (laser.beams - 1);
  settings.steps_per_turn = static_cast<int>(std::lround(2.0 * kPi / step));
  const double turn = static_cast<double>(laser.sweep_us) * 2.0 * kPi / laser.field_of_view;
  settings.turns_per_minute = static_cast<int>(std::lround(6e7 / turn));
  return settings;
}

ScipEmulator::ScipEmulator(const ScipSettings& settings, uint64_t seed)
    : settings_(settings), random_(seed), scip1_(settings.scip1) {}

void ScipEmulator::receive(std::string_view bytes, int64_t /*utime*/) {
  if (faults_.silent) return;
  for (char byte : bytes) {
    if (byte == '\n' || byte == '\r') {
      if (!line_.empty() && line_.size() <= kLongestCommand) runLine(line_);
      line_.clear();
    } else if (line_.size() <= kLongestCommand) {
      line_ += byte;
    }
  }
}

std::string ScipEmulator::transmit(int64_t /*utime*/) {
  return faults_.silent ? (out_.clear(), std::string()) : std::exchange(out_, {});
}

void ScipEmulator::reconnect() {
  line_.clear();
  out_.clear();
  streaming_.reset();
}

void ScipEmulator::answer(const std::string& line, const std::string& status,
                          const std::vector<std::string>& lines) {
  out_ += line + "\n" + status + scipSum(status) + "\n";
  for (const std::string& text : lines) out_ += text + ";" + scipSum(text) + "\n";
  out_ += "\n";
}

/// SCIP 1.1: one character of status, without a sum; only the commands for leaving it.
bool ScipEmulator::runInScip1(const std::string& line) {
  if (!scip1_) return false;
  scip1_ = line != "SCIP2.0";
  out_ += line + (scip1_ ? "\nE\n\n" : "\n0\n\n");
  return true;
}

void ScipEmulator::runLine(const std::string& line) {
  if (runInScip1(line)) return;
  // A note after ';' belongs to the echo, not to the command.
  const std::string command = line.substr(0, line.find(';'));
  const std::string name = command.substr(0, 2);
  if (name == "MD" || name == "MS") return startMeasuring(line);
  if (name == "II")
    return answer(line, "00",
                  {"MODL:" + settings_.model, std::string("LASR:") + (laser_on_ ? "ON" : "OFF"),
                   faults_.ill ? "STAT:Malfunction 005" : "STAT:Sensor works well."});
  if (name == "PP") return answer(line, "00", parameterLines());
  if (name == "VV") return answer(line, "00", versionLines());
  if (name == "BM") {
    if (faults_.ill) return answer(line, "01");
    const bool was_on = std::exchange(laser_on_, true);
    return answer(line, was_on ? "02" : "00");
  }
  if (name == "QT" || name == "RS") {
    streaming_.reset();
    laser_on_ = false;
    return answer(line, "00");
  }
  const bool speed = name == "SS" && digits(command, 2, 6).has_value();
  const bool sensitivity = command == "HS0" || command == "HS1";
  if (command == "SCIP2.0" || speed || sensitivity) return answer(line, "00");
  answer(line, "0E");
}

std::vector<std::string> ScipEmulator::versionLines() const {
  return {"VEND:Tread simulator", "PROD:" + settings_.model, "FIRM:1.0", "PROT:SCIP 2.0",
          "SERI:" + settings_.serial_number};
}

std::vector<std::string> ScipEmulator::parameterLines() const {
  const auto line = [](const char* key, int value) { return key + std::to_string(value); };
  return {"MODL:" + settings_.model,
          line("DMIN:", settings_.range_min_mm),
          line("DMAX:", settings_.range_max_mm),
          line("ARES:", settings_.steps_per_turn),
          line("AMIN:", settings_.first_step),
          line("AMAX:", settings_.last_step),
          line("AFRT:", settings_.front_step),
          line("SCAN:", settings_.turns_per_minute)};
}

std::string ScipEmulator::parseRequest(const std::string& line, Request& request) const {
  const std::string command = line.substr(0, line.find(';'));
  if (command.size() != 15u) return "0C";
  const auto first = digits(command, 2, 4), last = digits(command, 6, 4);
  const auto cluster = digits(command, 10, 2);
  const auto interval = digits(command, 12, 1), count = digits(command, 13, 2);
  if (!first) return "01";
  if (!last) return "02";
  if (!cluster) return "03";
  if (*last > settings_.last_step) return "04";
  if (*last < *first) return "05";
  if (!interval) return "06";
  if (!count) return "07";
  request = {command.substr(0, 13),
             line.substr(command.size()),
             command[1] == 'S' ? 2 : 3,
             *first,
             *last,
             std::max(1, *cluster),
             *interval,
             *count,
             *count == 0};
  return "00";
}

void ScipEmulator::startMeasuring(const std::string& line) {
  Request request;
  const std::string status = parseRequest(line, request);
  answer(line, status);
  if (status != "00") return;
  laser_on_ = true;
  streaming_ = request;
  skipped_ = request.interval;
}

void ScipEmulator::add(const LaserScan& scan) {
  if (faults_.silent || !streaming_) return;
  Request& request = *streaming_;
  if (skipped_ < request.interval) {
    ++skipped_;
    return;
  }
  skipped_ = 0;
  if (!request.endless) --request.count;
  if (faults_.garbage) {
    for (uint64_t i = random_() % 30; i > 0; --i) out_ += static_cast<char>(random_() % 256);
  }
  const std::string echo = request.command + twoDigits(request.count) + request.note + "\n";
  std::string out = echo + "99b\n";
  const size_t values = out.size();
  appendScan(out, scan, request);
  spoil(out, values);
  out_ += faults_.trouble ? echo + "50U\n\n" : out;
  if (!request.endless && request.count == 0) streaming_.reset();
}

/// `values`: where they begin.
void ScipEmulator::spoil(std::string& scan, size_t values) {
  const bool draws = faults_.bad_sums || faults_.dropped_byte;
  const size_t at = draws ? values + random_() % (scan.size() - values) : values;
  if (faults_.bad_sums) scan[at] ^= 0x05;
  if (faults_.dropped_byte) scan.erase(at, 1);
  if (faults_.half_scan) scan.erase(scan.size() / 2);
  if (!faults_.repeats) return first_scan_.clear();
  if (first_scan_.empty()) first_scan_ = scan;
  scan = first_scan_;
}

void ScipEmulator::appendScan(std::string& out, const LaserScan& scan,
                              const Request& request) const {
  const std::string time = scipEncode(deviceTime(scan.utime), 4);
  out += time + scipSum(time) + "\n";
  const std::string ranges = rangesOf(scan, request);
  for (size_t at = 0; at < ranges.size(); at += kLineLength) {
    const std::string_view line = std::string_view(ranges).substr(at, kLineLength);
    out.append(line);
    out += scipSum(line);
    out += '\n';
  }
  out += '\n';
}

std::string ScipEmulator::rangesOf(const LaserScan& scan, const Request& request) const {
  std::string text;
  for (int step = request.first; step <= request.last; step += request.cluster) {
    uint32_t nearest = kNothingHit;
    const int end = std::min(request.last, step + request.cluster - 1);
    for (int i = step; i <= end; ++i) {
      const auto beam = static_cast<size_t>(i - settings_.first_step);
      const float range = beam < scan.ranges.size() ? scan.ranges[beam] : NAN;
      if (std::isnan(range)) {
        nearest = std::min(nearest, kNoMeasurement);
      } else if (std::isfinite(range)) {
        nearest = std::min(nearest, static_cast<uint32_t>(std::lround(1000.0 * range)));
      }
    }
    if (request.characters == 2) nearest = std::min(nearest, kMostOfTwo);
    text += scipEncode(nearest, request.characters);
  }
  return text;
}

}  // namespace tread::sim
