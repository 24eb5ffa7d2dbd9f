// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/import/foreign_types.hpp"

#include <cstring>

namespace tread::import {
namespace {

/// lcm-gen's hash of a series of bytes.
class FieldHash {
 public:
  void add(uint64_t value) {
    // The rule shifts a signed number to the right.
    const auto high = static_cast<uint64_t>(static_cast<int64_t>(value_) >> 55);
    value_ = ((value_ << 8) ^ high) + value;
  }
  void add(const std::string& text) {
    add(text.size());
    for (const char letter : text) add(static_cast<uint64_t>(letter));
  }
  uint64_t value() const { return value_; }

 private:
  uint64_t value_ = 0x12345678;
};

size_t sizeOf(const std::string& type) {
  static const std::map<std::string, size_t> sizes = {
      {"boolean", 1}, {"int16_t", 2}, {"int32_t", 4}, {"int64_t", 8}, {"float", 4}, {"double", 8}};
  return sizes.at(type);
}

uint64_t bigEndian(const uint8_t* bytes, size_t size) {
  uint64_t value = 0;
  for (size_t i = 0; i < size; ++i) value = value << 8 | bytes[i];
  return value;
}

template <class Number, class Bits>
double numberOf(uint64_t value) {
  const auto bits = static_cast<Bits>(value);
  Number number;
  std::memcpy(&number, &bits, sizeof number);
  return static_cast<double>(number);
}

double numberOf(const std::string& type, const uint8_t* bytes) {
  const uint64_t value = bigEndian(bytes, sizeOf(type));
  if (type == "float") return numberOf<float, uint32_t>(value);
  if (type == "double") return numberOf<double, uint64_t>(value);
  if (type == "int64_t") return numberOf<int64_t, uint64_t>(value);
  if (type == "int32_t") return numberOf<int32_t, uint32_t>(value);
  if (type == "int16_t") return numberOf<int16_t, uint16_t>(value);
  return value != 0 ? 1.0 : 0.0;
}

constexpr size_t kFingerprintBytes = 8;

}  // namespace

uint64_t ForeignType::fingerprint() const {
  constexpr uint64_t kVariableLength = 1;
  FieldHash hash;
  for (const ForeignField& field : fields) {
    hash.add(field.name);
    hash.add(field.type);
    hash.add(field.length.empty() ? 0 : 1);  // dimensions
    if (field.length.empty()) continue;
    hash.add(kVariableLength);
    hash.add(field.length);
  }
  return hash.value() << 1 | hash.value() >> 63;
}

const std::vector<ForeignType>& foreignTypes() {
  static const std::vector<ForeignType> types = {
      // Of the same fields, and so the same to a log: odometry_t of the later robots.
      {"pose_xyt_t",
       {{"int64_t", "utime", ""}, {"float", "x", ""}, {"float", "y", ""}, {"float", "theta", ""}}},
      {"odometry_t",
       {{"int64_t", "utime", ""},
        {"float", "x", ""},
        {"float", "y", ""},
        {"float", "theta", ""},
        {"float", "total_left_distance", ""},
        {"float", "total_right_distance", ""},
        {"float", "wheelbase", ""},
        {"float", "left_wheel_speed", ""},
        {"float", "right_wheel_speed", ""}}},
      // Also rplidar_laser_t.
      {"lidar_t",
       {{"int64_t", "utime", ""},
        {"int32_t", "num_ranges", ""},
        {"float", "ranges", "num_ranges"},
        {"float", "thetas", "num_ranges"},
        {"int64_t", "times", "num_ranges"},
        {"float", "intensities", "num_ranges"}}},
      {"mbot_motor_command_t",
       {{"int64_t", "utime", ""}, {"float", "trans_v", ""}, {"float", "angular_v", ""}}},
      {"mbot_motor_pwm_t",
       {{"int64_t", "utime", ""},
        {"float", "left_motor_pwm", ""},
        {"float", "right_motor_pwm", ""}}},
      {"mbot_wheel_ctrl_t",
       {{"int64_t", "utime", ""},
        {"float", "left_motor_pwm_cmd", ""},
        {"float", "right_motor_pwm_cmd", ""},
        {"float", "left_motor_vel_cmd", ""},
        {"float", "right_motor_vel_cmd", ""},
        {"float", "left_motor_vel", ""},
        {"float", "right_motor_vel", ""}}},
      {"maebot_motor_command_t",
       {{"int64_t", "utime", ""},
        {"float", "left_motor_speed", ""},
        {"float", "right_motor_speed", ""},
        {"boolean", "left_motor_enabled", ""},
        {"boolean", "right_motor_enabled", ""}}},
  };
  return types;
}

const ForeignType* foreignTypeOf(const std::vector<uint8_t>& bytes) {
  if (bytes.size() < kFingerprintBytes) return nullptr;
  const uint64_t fingerprint = bigEndian(bytes.data(), kFingerprintBytes);
  for (const ForeignType& type : foreignTypes())
    if (type.fingerprint() == fingerprint) return &type;
  return nullptr;
}

std::optional<ForeignMessage> decodeForeign(const ForeignType& type,
                                            const std::vector<uint8_t>& bytes) {
  ForeignMessage message;
  size_t at = kFingerprintBytes;
  for (const ForeignField& field : type.fields) {
    const double count = field.length.empty() ? 1.0 : message[field.length].at(0);
    const size_t size = sizeOf(field.type);
    const size_t rest = bytes.size() > at ? bytes.size() - at : 0;
    if (count < 0.0 || count > static_cast<double>(rest / size)) return std::nullopt;
    std::vector<double>& numbers = message[field.name];
    for (size_t i = 0; i < static_cast<size_t>(count); ++i, at += size)
      numbers.push_back(numberOf(field.type, bytes.data() + at));
  }
  if (at != bytes.size()) return std::nullopt;
  return message;
}

}  // namespace tread::import
