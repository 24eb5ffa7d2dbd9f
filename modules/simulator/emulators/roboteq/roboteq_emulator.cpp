// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/emulators/roboteq/roboteq_emulator.hpp"

#include <cctype>
#include <charconv>
#include <cmath>
#include <utility>

namespace tread::sim {
namespace {

constexpr int kFullCommand = 1000;       // per mille
constexpr int kLongestWatchdog = 65000;  // [ms]
constexpr int64_t kMicrosPerMilli = 1000;

std::optional<int> integerOf(const std::string& word) {
  int value = 0;
  const auto result = std::from_chars(word.data(), word.data() + word.size(), value);
  if (result.ec != std::errc() || result.ptr != word.data() + word.size()) return std::nullopt;
  return value;
}

bool within(const std::optional<int>& value, int low, int high) {
  return value && *value >= low && *value <= high;
}

std::string sign(bool good) {
  return good ? "+" : "-";
}

constexpr double kBrownOutVoltage = 12.0;  // remaining motor supply [V]
constexpr int kUndervoltageFault = 4;      // bits of ?FF
constexpr int kEmergencyStopFault = 16;
constexpr int kSerialStatus = 1;  // bits of ?FS
constexpr int kPowerStageOffStatus = 8;

int rounded(double value) {
  return static_cast<int>(std::lround(value));
}

constexpr size_t kLongestLine = 64;  // longer ones are refused
constexpr char kEnquiry = 0x05;
constexpr char kAcknowledge = 0x06;

}  // namespace

RoboteqWords roboteqWords(const std::string& text) {
  RoboteqWords words;
  size_t i = 0;
  while (i < text.size() && text[i] == ' ') ++i;
  while (i < text.size() && std::isalpha(static_cast<unsigned char>(text[i])))
    words.name += text[i++];
  std::string word;
  for (; i <= text.size(); ++i) {
    if (i < text.size() && text[i] != ' ') {
      word += text[i];
    } else if (!word.empty()) {
      words.numbers.push_back(integerOf(word));
      word.clear();
    }
  }
  return words;
}

std::optional<std::string> RoboteqFirmware::execute(const std::string& line, int64_t utime) {
  if (line.empty()) return std::nullopt;
  const RoboteqWords words = roboteqWords(line.substr(1));
  switch (line[0]) {
    case '!':
      return sign(runCommand(words, utime));
    case '?':
      return answer(words).value_or(sign(false));
    case '^':
      return sign(setConfiguration(words));
    case '~':
      return readConfiguration(words.name).value_or(sign(false));
    default:
      return sign(false);
  }
}

void RoboteqFirmware::advance(int64_t utime) {
  if (configuration_.watchdog_ms == 0 || !serial_active_) return;
  if (utime - last_command_ >= configuration_.watchdog_ms * kMicrosPerMilli) serial_active_ = false;
}

void RoboteqFirmware::powerUp() {
  configuration_ = {};
  commanded_ = {0, 0};
  serial_active_ = false;
  emergency_stop_ = false;
}

bool RoboteqFirmware::runCommand(const RoboteqWords& words, int64_t utime) {
  bool good = false;
  if (words.name == "M") good = setBoth(words.numbers);
  if (words.name == "G") good = setOne(words.numbers);
  if (words.name == "MS") good = stop(words.numbers);
  if ((words.name == "EX" || words.name == "MG") && words.numbers.empty()) {
    emergency_stop_ = words.name == "EX";
    good = true;
  }
  if (!good) return false;
  // Any good command makes the serial line the active source again: the stored speeds apply.
  serial_active_ = true;
  last_command_ = utime;
  return true;
}

bool RoboteqFirmware::setBoth(const Numbers& numbers) {
  if (numbers.empty() || numbers.size() > 2) return false;
  for (const auto& value : numbers) {
    if (!within(value, -kFullCommand, kFullCommand)) return false;
  }
  for (size_t i = 0; i < numbers.size(); ++i) commanded_[i] = *numbers[i];
  return true;
}

bool RoboteqFirmware::setOne(const Numbers& numbers) {
  if (numbers.empty() || numbers.size() > 2) return false;
  const std::optional<int> channel = numbers.size() == 2 ? numbers[0] : std::optional<int>(1);
  if (!within(channel, 1, 2) || !within(numbers.back(), -kFullCommand, kFullCommand)) return false;
  commanded_[static_cast<size_t>(*channel - 1)] = *numbers.back();
  return true;
}

bool RoboteqFirmware::stop(const Numbers& numbers) {
  if (numbers.empty()) {
    commanded_ = {0, 0};
    return true;
  }
  if (numbers.size() > 1 || !within(numbers[0], 1, 2)) return false;
  commanded_[static_cast<size_t>(*numbers[0] - 1)] = 0;
  return true;
}

bool RoboteqFirmware::setConfiguration(const RoboteqWords& words) {
  if (words.numbers.size() != 1) return false;
  if (words.name == "RWD" && within(words.numbers[0], 0, kLongestWatchdog)) {
    configuration_.watchdog_ms = *words.numbers[0];
    return true;
  }
  if (words.name == "ECHOF" && within(words.numbers[0], 0, 1)) {
    configuration_.echo_off = *words.numbers[0] == 1;
    return true;
  }
  return false;
}

std::optional<std::string> RoboteqFirmware::readConfiguration(const std::string& name) const {
  if (name == "RWD") return "RWD=" + std::to_string(configuration_.watchdog_ms);
  if (name == "ECHOF") return std::string(configuration_.echo_off ? "ECHOF=1" : "ECHOF=0");
  return std::nullopt;
}

bool RoboteqFirmware::supplyLow() const {
  return brown_out_ || measurements_.battery_voltage < settings_.undervoltage;
}

std::array<int, 2> RoboteqFirmware::applied() const {
  return serial_active_ && powerStageOn() ? commanded_ : std::array<int, 2>{0, 0};
}

std::optional<std::string> RoboteqFirmware::answer(const RoboteqWords& words) const {
  if (words.numbers.size() > 1) return std::nullopt;
  const int parts = words.name == "V" ? 3 : 2;
  for (const auto& number : words.numbers) {
    if (!number || *number < 1 || *number > parts) return std::nullopt;
  }
  if (words.name == "V") return "V=" + voltages(words.numbers);
  if (words.name == "FF") {
    return "FF=" + std::to_string((supplyLow() ? kUndervoltageFault : 0) |
                                  (emergency_stop_ ? kEmergencyStopFault : 0));
  }
  if (words.name == "FS") {
    return "FS=" + std::to_string((serial_active_ ? kSerialStatus : 0) |
                                  (powerStageOn() ? 0 : kPowerStageOffStatus));
  }
  if (words.name == "FID") return std::string("FID=Roboteq v2.0 MDC2460 emulated by Tread");
  if (words.name == "T") return std::string("T=32:30:30");
  return channelAnswer(words);
}

std::string RoboteqFirmware::voltages(const Numbers& numbers) const {
  const double battery = brown_out_ ? kBrownOutVoltage : measurements_.battery_voltage;
  // Driver supply in 0.1 V, battery in 0.1 V, 5 V rail in mV.
  const std::array<std::string, 3> parts{"135", std::to_string(rounded(10.0 * battery)), "4980"};
  if (!numbers.empty()) return parts[static_cast<size_t>(*numbers[0] - 1)];
  return parts[0] + ":" + parts[1] + ":" + parts[2];
}

std::optional<std::string> RoboteqFirmware::channelAnswer(const RoboteqWords& words) const {
  const std::array<int, 2> power = applied();
  std::array<int, 2> values{};
  for (size_t i = 0; i < 2; ++i) {
    const double current = measurements_.motor_current[i];
    if (words.name == "M" || words.name == "P") {
      values[i] = power[i];
    } else if (words.name == "A") {
      values[i] = rounded(10.0 * current);
    } else if (words.name == "BA") {
      values[i] = rounded(10.0 * std::abs(power[i]) / 1000.0 * current);
    } else if (words.name == "FM") {
      values[i] = 0;
    } else if (words.name == "S" && settings_.encoders) {
      values[i] = rounded(settings_.rpm_per_speed * measurements_.track_speed[i]);
    } else {
      return std::nullopt;
    }
  }
  const std::string name = words.name + "=";
  if (words.numbers.empty())
    return name + std::to_string(values[0]) + ":" + std::to_string(values[1]);
  return name + std::to_string(values[static_cast<size_t>(*words.numbers[0] - 1)]);
}

RoboteqEmulator::RoboteqEmulator(const RoboteqSettings& settings)
    : SerialMotorEmulator(settings.baud, settings.reply_delay_us, settings.boot_us),
      firmware_(settings) {}

MotorValues RoboteqEmulator::output(int64_t utime) {
  advance(utime);
  const std::array<int, 2> applied = firmware_.applied();
  return {applied[0] / 1000.0, applied[1] / 1000.0};
}

void RoboteqEmulator::powerUp(int64_t /*utime*/) {
  line_.clear();
  firmware_.powerUp();
}

void RoboteqEmulator::hear(char byte, int64_t utime) {
  if (byte == kEnquiry) {
    say(std::string_view(&kAcknowledge, 1), utime);
    return;
  }
  const bool end = byte == '\r' || byte == '_';
  if (!end && byte < ' ') return;
  if (firmware_.echo()) say(std::string_view(&byte, 1), utime);
  if (end) {
    endLine(utime);
  } else if (line_.size() <= kLongestLine) {
    line_ += static_cast<char>(std::toupper(static_cast<unsigned char>(byte)));
  }
}

void RoboteqEmulator::endLine(int64_t utime) {
  const std::string line = std::exchange(line_, {});
  if (line.size() > kLongestLine) return reply("-\r", utime);
  const auto answer = firmware_.execute(line, utime);
  if (answer) reply(*answer + "\r", utime);
}

}  // namespace tread::sim
