// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/emulators/serial_motor_emulator.hpp"

namespace tread::sim {

void SerialMotorEmulator::receive(std::string_view bytes, int64_t utime) {
  advance(utime);
  from_robot_.send(bytes, utime);
}

std::string SerialMotorEmulator::transmit(int64_t utime) {
  advance(utime);
  std::string out = to_robot_.takeArrived(utime);
  return silent_ ? std::string() : out;
}

void SerialMotorEmulator::reboot(int64_t utime) {
  advance(utime);
  from_robot_.clear();
  to_robot_.clear();
  deaf_until_ = utime + boot_us_;
  powerUp(deaf_until_);
}

void SerialMotorEmulator::advance(int64_t utime) {
  while (from_robot_.arrived(utime)) {
    const SerialLine::Byte byte = from_robot_.front();
    from_robot_.pop();
    run(byte.utime);
    if (!silent_ && byte.utime >= deaf_until_) hear(byte.value, byte.utime);
  }
  run(utime);
}

void SerialMotorEmulator::reply(std::string bytes, int64_t utime) {
  if (lost_replies_ > 0) {
    --lost_replies_;
    return;
  }
  if (garble_reply_) bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  if (cut_reply_) bytes.resize(bytes.size() / 2);
  garble_reply_ = cut_reply_ = false;
  to_robot_.send(bytes, utime + reply_delay_us_);
}

}  // namespace tread::sim
