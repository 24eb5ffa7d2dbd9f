// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/emulators/roboteq/roboteq_emulator.hpp"

#include <cctype>
#include <utility>

namespace tread::sim {
namespace {

constexpr size_t kLongestLine = 64;  // what is longer is refused
constexpr char kEnquiry = 0x05;
constexpr char kAcknowledge = 0x06;

}  // namespace

RoboteqEmulator::RoboteqEmulator(const RoboteqSettings& settings)
    : settings_(settings),
      firmware_(settings),
      from_robot_(settings.baud),
      to_robot_(settings.baud) {}

void RoboteqEmulator::receive(std::string_view bytes, int64_t utime) {
  advance(utime);
  from_robot_.send(bytes, utime);
}

std::string RoboteqEmulator::transmit(int64_t utime) {
  advance(utime);
  std::string out = to_robot_.takeArrived(utime);
  return silent_ ? std::string() : out;
}

std::array<double, 2> RoboteqEmulator::output(int64_t utime) {
  advance(utime);
  const std::array<int, 2> applied = firmware_.applied();
  return {applied[0] / 1000.0, applied[1] / 1000.0};
}

void RoboteqEmulator::reboot(int64_t utime) {
  advance(utime);
  from_robot_.clear();
  to_robot_.clear();
  line_.clear();
  firmware_.powerUp();
  deaf_until_ = utime + settings_.boot_us;
}

void RoboteqEmulator::advance(int64_t utime) {
  while (from_robot_.arrived(utime)) {
    const SerialLine::Byte byte = from_robot_.front();
    from_robot_.pop();
    firmware_.advance(byte.utime);
    if (!silent_ && byte.utime >= deaf_until_) hear(byte.value, byte.utime);
  }
  firmware_.advance(utime);
}

void RoboteqEmulator::hear(char byte, int64_t utime) {
  if (byte == kEnquiry) {
    to_robot_.send(std::string_view(&kAcknowledge, 1), utime);
    return;
  }
  const bool end = byte == '\r' || byte == '_';
  if (!end && byte < ' ') return;
  if (firmware_.echo()) to_robot_.send(std::string_view(&byte, 1), utime);
  if (end) {
    endLine(utime);
  } else if (line_.size() <= kLongestLine) {
    line_ += static_cast<char>(std::toupper(static_cast<unsigned char>(byte)));
  }
}

void RoboteqEmulator::endLine(int64_t utime) {
  const std::string line = std::exchange(line_, {});
  if (line.size() > kLongestLine) return reply("-", utime);
  const auto answer = firmware_.execute(line, utime);
  if (answer) reply(*answer, utime);
}

void RoboteqEmulator::reply(const std::string& line, int64_t utime) {
  if (lost_replies_ > 0) {
    --lost_replies_;
    return;
  }
  const std::string whole = line + "\r";
  const size_t length = cut_reply_ ? whole.size() / 2 : whole.size();
  cut_reply_ = false;
  to_robot_.send(whole.substr(0, length), utime + settings_.reply_delay_us);
}

}  // namespace tread::sim
