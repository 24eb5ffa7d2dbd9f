// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/line_protocol/line_description.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "modules/motor_bridge/core/checksums.hpp"

namespace tread::motor {
namespace {

const std::set<std::string> kNone;
const std::set<std::string> kWatchdog{"watchdog"};
const std::set<std::string> kReadings{"watchdog",      "battery_voltage", "current_left",
                                      "current_right", "speed_left",      "speed_right",
                                      "temperature",   "faults"};

LineTemplate templateOf(const ConfigReader& reader, const std::string& key, const std::string& text,
                        const std::set<std::string>& known, bool written) {
  try {
    LineTemplate line(text);
    if (text.empty()) throw std::invalid_argument("is empty");
    if (written && !line.isWritable()) throw std::invalid_argument("{_} can only be read");
    for (const std::string& name : line.names())
      if (known.count(name) == 0) throw std::invalid_argument("{" + name + "} is not known here");
    return line;
  } catch (const std::invalid_argument& refusal) {
    throw reader.error(key, "\"" + text + "\": " + refusal.what());
  }
}

std::vector<LineTemplate> templatesOf(ConfigReader& reader, const std::string& key,
                                      const std::set<std::string>& known, bool written,
                                      bool required = false) {
  std::vector<std::string> texts;
  reader.texts(key, texts, required);
  std::vector<LineTemplate> lines;
  for (const std::string& text : texts)
    lines.push_back(templateOf(reader, key, text, known, written));
  return lines;
}

/// A line without numbers.
std::string plainOf(ConfigReader& reader, const std::string& key) {
  std::string text;
  reader.text(key, text);
  return text.empty() ? text : templateOf(reader, key, text, kNone, true).format({});
}

/// The readings that a robot's reply may contain.
std::set<std::string> readingsOf(const LineDescription& line) {
  if (line.invert_wheels.empty()) return kReadings;
  std::set<std::string> names{"watchdog", "battery_voltage", "temperature", "faults"};
  for (const std::string& wheel : line.wheels()) {
    names.insert("current_" + wheel);
    names.insert("speed_" + wheel);
  }
  return names;
}

std::vector<LineExchange> exchangesOf(ConfigReader& reader, const std::string& key,
                                      const std::set<std::string>& readings) {
  std::vector<LineExchange> exchanges;
  for (ConfigReader& item : reader.sections(key)) {
    std::string send, expect;
    item.text("send", send, true);
    item.text("expect", expect, true);
    exchanges.push_back({templateOf(item, "send", send, kWatchdog, true),
                         templateOf(item, "expect", expect, readings, false)});
  }
  return exchanges;
}

void readFrame(ConfigReader& reader, LineDescription& line) {
  std::string end = "cr";
  reader.choice("line_end", end, {"cr", "lf", "crlf"});
  line.end = end == "cr" ? "\r" : end == "lf" ? "\n" : "\r\n";
  std::string checksum = "none";
  const std::vector<std::string> kinds{"none", "xor", "sum8", "crc8", "crc16"};
  reader.choice("checksum", checksum, kinds);
  line.checksum =
      static_cast<LineChecksum>(std::find(kinds.begin(), kinds.end(), checksum) - kinds.begin());
  line.checksum_mark = plainOf(reader, "checksum_mark");
  int64_t skip = 0;
  reader.integer("checksum_skip", skip, {0.0, 8.0}, "characters");
  line.checksum_skip = static_cast<size_t>(skip);
}

void readSteering(ConfigReader& reader, LineDescription& line) {
  reader.number("full_steering", line.full_steering, {-1e8, 1e8}, "counts");
  reader.number("steering_centre", line.steering_centre, {-1e8, 1e8}, "counts");
  if (line.full_steering == 0.0)
    throw reader.error("full_steering", "is zero: nothing would be steered");
}

void readCommands(ConfigReader& reader, LineDescription& line) {
  const bool car = line.max_steering > 0.0;
  const std::vector<std::string> wheels = line.wheels();
  const std::set<std::string> names = car ? std::set<std::string>{"throttle", "steering"}
                                      : wheels.empty()
                                          ? std::set<std::string>{"left", "right"}
                                          : std::set<std::string>(wheels.begin(), wheels.end());
  line.command = templatesOf(reader, "command", names, true, true);
  if (car) readSteering(reader, line);
  for (const std::string& name : names) {
    if (std::none_of(line.command.begin(), line.command.end(),
                     [&](const LineTemplate& text) { return text.has(name); }))
      throw reader.error("command", "never contains {" + name + "}; give " +
                                        (car              ? "throttle and steering"
                                         : wheels.empty() ? "both tracks"
                                                          : "all wheels"));
    if (name == "steering" && line.steering_centre >= std::abs(line.full_steering)) continue;
    for (const LineTemplate& text : line.command)
      if (!text.takesNegative(name))
        throw reader.error("command", "{" + name + "} cannot be negative; write a hexadecimal " +
                                          "with +, as {" + name + ":+04x}");
  }
  line.stop = templatesOf(reader, "stop", kNone, true);
  reader.number("full_command", line.full_command, {0.01, 1e8}, "counts");
  line.acknowledge = plainOf(reader, "acknowledge");
  line.errors = templatesOf(reader, "errors", kReadings, false);
  line.restarted = plainOf(reader, "restarted");
  line.emergency_stop = plainOf(reader, "emergency_stop");
  line.release_stop = plainOf(reader, "release_stop");
  if (line.emergency_stop.empty() != line.release_stop.empty())
    throw reader.error(line.emergency_stop.empty() ? "release_stop" : "emergency_stop",
                       "needs the other one of emergency_stop and release_stop");
}

void readTelemetry(ConfigReader& reader, LineDescription& line) {
  line.start = exchangesOf(reader, "start", readingsOf(line));
  line.queries = exchangesOf(reader, "queries", readingsOf(line));
  reader.seconds("query_interval", line.query_interval_us, {0.01, 1.0});
  for (ConfigReader& item : reader.sections("faults")) {
    LineFault fault;
    int64_t mask = 0;
    item.integer("mask", mask, {1.0, 2147483647.0}, "", true);
    fault.mask = static_cast<int32_t>(mask);
    item.text("means", fault.means, true);
    item.flag("latched", fault.latched);
    item.flag("voltage", fault.voltage);
    line.faults.push_back(fault);
  }
  ConfigReader units = reader.section("units");
  units.number("watchdog", line.watchdog_unit, {1e-6, 10.0}, "s");
  units.number("battery_voltage", line.battery_voltage, {1e-6, 100.0}, "V");
  units.number("current", line.current, {1e-6, 100.0}, "A");
  units.number("speed", line.speed, {1e-9, 100.0}, "m/s");
  units.number("temperature", line.temperature, {1e-6, 100.0}, "degC");
}

uint32_t checksumOf(LineChecksum kind, std::string_view text) {
  switch (kind) {
    case LineChecksum::kXor:
      return xorOf(text);
    case LineChecksum::kSum8:
      return sum8(text);
    case LineChecksum::kCrc8:
      return crc8(text);
    case LineChecksum::kCrc16:
      return crc16(text);
    case LineChecksum::kNone:
      return 0;
  }
  return 0;
}

const LineTemplate& checksumForm(LineChecksum kind) {
  static const LineTemplate kByte("{c:02X}");
  static const LineTemplate kWord("{c:04X}");
  return kind == LineChecksum::kCrc16 ? kWord : kByte;
}

}  // namespace

LineDescription readLineDescription(ConfigReader& reader, const DriveDescription& drive) {
  LineDescription line;
  line.full_scale = drive.fullCommand();
  line.swapped = drive.left_channel == 2;
  line.max_steering = drive.max_steering;
  line.invert_wheels = drive.invert_wheels;
  line.invert_left = drive.invert_left;
  line.invert_right = drive.invert_right;
  reader.text("name", line.name, true);
  readFrame(reader, line);
  readCommands(reader, line);
  readTelemetry(reader, line);
  // Zero is repeated every 0.1 s: a shorter watchdog would expire while the robot stands.
  reader.seconds("watchdog", line.times.watchdog_us, {0.15, 1.0});
  reader.seconds("reply_timeout", line.times.reply_timeout_us, {0.02, 0.2});
  return line;
}

std::vector<std::string> LineDescription::wheels() const {
  std::vector<std::string> names;
  while (names.size() < invert_wheels.size())
    names.push_back("wheel" + std::to_string(names.size() + 1));
  return names;
}

bool LineDescription::readsWatchdog() const {
  return std::any_of(start.begin(), start.end(),
                     [](const LineExchange& step) { return step.expect.has("watchdog"); });
}

double LineDescription::watchdogCounts() const {
  return 1e-6 * static_cast<double>(times.watchdog_us) / watchdog_unit;
}

std::string LineDescription::framed(const std::string& line) const {
  if (checksum == LineChecksum::kNone) return line + end;
  const std::string_view covered =
      std::string_view(line).substr(std::min(checksum_skip, line.size()));
  const double value = checksumOf(checksum, covered);
  return line + checksum_mark + checksumForm(checksum).format({{"c", value}}) + end;
}

bool LineDescription::unframe(std::string& line) const {
  if (checksum == LineChecksum::kNone) return true;
  const size_t digits = checksum == LineChecksum::kCrc16 ? 4 : 2;
  const size_t tail = checksum_mark.size() + digits;
  if (line.size() < tail + checksum_skip) return false;
  const std::string body = line.substr(0, line.size() - tail);
  const std::string behind = line.substr(body.size());
  if (behind.compare(0, checksum_mark.size(), checksum_mark) != 0) return false;
  const auto said = checksumForm(checksum).match(behind.substr(checksum_mark.size()));
  const auto wanted = checksumOf(checksum, std::string_view(body).substr(checksum_skip));
  line = body;
  return said && said->at("c") == static_cast<double>(wanted);
}

}  // namespace tread::motor
