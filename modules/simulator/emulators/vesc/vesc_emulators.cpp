// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/emulators/vesc/vesc_emulators.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace tread::sim {
namespace {

constexpr int64_t kBoot = 500'000;  // [us]
constexpr int64_t kReplyDelay = 500;
constexpr int64_t kStatusPeriod = 20'000;
constexpr size_t kFrame = 16;

/// The firmware's CRC, by bits of the message: x^16 + x^12 + x^5 + 1, from 0.
unsigned crcOf(const std::string& text) {
  unsigned crc = 0;
  for (const char c : text) {
    unsigned next = (crc >> 8 ^ static_cast<unsigned char>(c)) & 0xffU;
    next ^= next >> 4;
    crc = (crc << 8 ^ next << 12 ^ next << 5 ^ next) & 0xffffU;
  }
  return crc;
}

struct Writer {
  std::string bytes;
  Writer& put(double value, int size) {
    const long long number = std::llround(value);
    for (int i = size - 1; i >= 0; --i) bytes += static_cast<char>(number >> (8 * i) & 0xff);
    return *this;
  }
};

int32_t number(const std::string& bytes, size_t at) {
  uint32_t word = 0;
  for (size_t i = 0; i < 4; ++i) word = word * 256 + static_cast<unsigned char>(bytes[at + i]);
  return static_cast<int32_t>(word);
}

std::string values(const VescMotor& motor) {
  Writer out;
  out.put(4, 1).put(312, 2).put(280, 2).put(100 * motor.current(), 4);
  out.put(100 * std::abs(motor.duty()) * motor.current(), 4).put(0, 4).put(0, 4);
  out.put(1000 * motor.duty(), 2).put(motor.erpm(), 4).put(10 * motor.battery(), 2);
  for (int i = 0; i < 6; ++i) out.put(0, 4);  // charge, energy, turns
  out.put(motor.fault(), 1).put(0, 4).put(motor.id(), 1);
  return out.put(300, 2).put(300, 2).put(300, 2).put(0, 4).put(0, 4).put(0, 1).bytes;
}

/// The relevant part, padded to a real one's length.
std::string appConfiguration(const VescMotor& motor) {
  Writer out;
  out.put(17, 1)
      .put(0x2A9C4B01, 4)
      .put(motor.id(), 1)
      .put(static_cast<double>(motor.timeoutMs()), 4);
  for (int i = 0; i < 400; ++i) out.put(i * 7 % 256, 1);
  return out.bytes;
}

std::string frame(unsigned packet, int id, const std::string& data) {
  std::string out(kFrame, '\0');
  const uint32_t identifier = 0x80000000U | packet << 8 | static_cast<uint32_t>(id);
  std::memcpy(out.data(), &identifier, 4);
  out[4] = static_cast<char>(data.size());
  std::memcpy(out.data() + 8, data.data(), data.size());
  return out;
}

}  // namespace

VescBank::VescBank(const VescSettings& settings)
    : channels_(settings.channels), has_servo_(settings.servo) {
  for (int id = 1; id <= settings.controllers; ++id) motors_.emplace_back(id, settings);
}

VescMotor* VescBank::find(int id) {
  for (VescMotor& motor : motors_)
    if (motor.id() == id) return &motor;
  return nullptr;
}

MotorValues VescBank::output(int64_t utime) {
  MotorValues sum{};
  for (size_t i = 0; i < motors_.size(); ++i) sum[i % channels_] += motors_[i].output(utime);
  if (has_servo_) return {sum[0], std::clamp((servo_ - 0.5) / 0.4, -1.25, 1.25)};
  const double share = static_cast<double>(channels_) / static_cast<double>(motors_.size());
  for (double& value : sum) value *= share;
  return sum;
}

MotorValues VescBank::heldSpeeds() const {
  MotorValues held{};
  for (size_t i = 0; i < std::min(channels_, motors_.size()); ++i) held[i] = motors_[i].heldSpeed();
  return held;
}

void VescBank::measure(const DriveMeasurements& seen) {
  const double share =
      has_servo_ ? 1.0 : static_cast<double>(channels_) / static_cast<double>(motors_.size());
  for (size_t i = 0; i < motors_.size(); ++i)
    motors_[i].measure(seen.track_speed[i % channels_], share * seen.motor_current[i % channels_],
                       seen.battery_voltage);
}

void VescBank::powerUp() {
  for (VescMotor& motor : motors_) motor.powerUp();
  servo_ = 0.5;
}

VescUartEmulator::VescUartEmulator(const VescSettings& settings)
    : SerialMotorEmulator(115200, kReplyDelay, kBoot), bank_(settings) {}

MotorValues VescUartEmulator::output(int64_t utime) {
  advance(utime);
  return bank_.output(utime);
}

void VescUartEmulator::powerUp(int64_t /*utime*/) {
  heard_.clear();
  bank_.powerUp();
}

void VescUartEmulator::hear(char byte, int64_t utime) {
  heard_ += byte;
  while (!heard_.empty()) {
    // Commands are short: packets of one length byte.
    const size_t size = heard_.size() < 2 ? 0 : static_cast<unsigned char>(heard_[1]);
    if (heard_[0] == 2 && (heard_.size() < 2 || heard_.size() < size + 5)) return;
    const std::string payload = heard_[0] == 2 ? heard_.substr(2, size) : "";
    Writer crc;
    crc.put(crcOf(payload), 2);
    if (!payload.empty() && heard_.substr(2 + size, 3) == crc.bytes + '\3') {
      heard_.erase(0, size + 5);
      execute(bank_.motors().front(), payload, utime);
    } else {
      heard_.erase(0, 1);
    }
  }
}

void VescUartEmulator::execute(VescMotor& motor, const std::string& payload, int64_t utime) {
  const int comm = static_cast<unsigned char>(payload[0]);
  const bool has_number = payload.size() == 5;
  if (comm == 0) answer(Writer().put(0, 1).put(6, 1).put(2, 1).bytes + std::string("60", 3), utime);
  if (comm == 4) answer(values(motor), utime);
  if (comm == 17) answer(appConfiguration(motor), utime);
  if (comm == 30) motor.keepAlive(utime);
  if (comm == 5 && has_number) motor.setDuty(number(payload, 1) / 1e5, utime);
  if (comm == 7 && has_number) motor.setBrake(number(payload, 1) / 1e3, utime);
  if (comm == 8 && has_number) motor.setRpm(number(payload, 1), utime);
  if (comm == 12 && payload.size() == 3)
    bank_.setServo(number(std::string(2, '\0') + payload.substr(1), 0) / 1e3);
  if (comm != 34 || payload.size() < 3) return;
  VescMotor* const other = bank_.find(static_cast<unsigned char>(payload[1]));
  if (other != nullptr && payload[2] != 34) execute(*other, payload.substr(2), utime);
}

void VescUartEmulator::answer(const std::string& payload, int64_t utime) {
  const bool is_long = payload.size() > 255;
  Writer packet;
  packet.put(is_long ? 3 : 2, 1).put(static_cast<double>(payload.size()), is_long ? 2 : 1);
  Writer end;
  end.put(crcOf(payload), 2).put(3, 1);
  reply(packet.bytes + payload + end.bytes, utime);
}

void VescCanEmulator::receive(std::string_view bytes, int64_t utime) {
  if (silent_ || utime < deaf_until_) return;
  heard_ += bytes;
  while (heard_.size() >= kFrame) {
    const std::string one = heard_.substr(0, kFrame);
    heard_.erase(0, kFrame);
    uint32_t identifier = 0;
    std::memcpy(&identifier, one.data(), 4);
    VescMotor* const motor = bank_.find(static_cast<int>(identifier & 0xff));
    const uint32_t packet = (identifier & 0x1fffffff) >> 8;
    if (motor == nullptr || one[4] != 4) continue;
    if (packet == 0) motor->setDuty(number(one, 8) / 1e5, utime);
    if (packet == 2) motor->setBrake(number(one, 8) / 1e3, utime);
    if (packet == 3) motor->setRpm(number(one, 8), utime);
  }
}

std::string VescCanEmulator::transmit(int64_t utime) {
  bank_.output(utime);
  if (silent_ || !settings_.statuses || utime < deaf_until_ || utime < next_status_) return {};
  next_status_ = utime + kStatusPeriod;
  std::string out;
  for (VescMotor& motor : bank_.motors()) {
    Writer status, temperatures, supply;
    status.put(motor.erpm(), 4).put(10 * motor.current(), 2).put(1000 * motor.duty(), 2);
    temperatures.put(312, 2).put(280, 2).put(0, 2).put(0, 2);
    supply.put(0, 4).put(10 * motor.battery(), 2).put(0, 2);
    out += frame(9, motor.id(), status.bytes) + frame(16, motor.id(), temperatures.bytes) +
           frame(27, motor.id(), supply.bytes);
  }
  return out;
}

void VescCanEmulator::reboot(int64_t utime) {
  heard_.clear();
  bank_.powerUp();
  deaf_until_ = utime + kBoot;
}

}  // namespace tread::sim
