// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/emulators/sick_lms2xx/lms_emulator.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tread::sim {
namespace {

constexpr char kAcknowledge = 0x06;
constexpr char kRefuse = 0x15;
constexpr char kStatus = 0x10;   // no error
constexpr int kFarthest = 8182;  // [mm] of 13 bits, before the words
constexpr int kNoEcho = 0x1FFF;  // a word: no echo

/// The checksum of the manual, as two bytes, the low one first.
std::string checksumOf(const std::string& bytes) {
  unsigned sum = 0;
  for (size_t i = 0; i < bytes.size(); ++i) {
    const unsigned low = static_cast<unsigned char>(bytes[i]);
    const unsigned high = i == 0 ? 0 : static_cast<unsigned char>(bytes[i - 1]);
    const unsigned carry = sum >> 15;
    sum = ((sum << 1) & 0xffffU) ^ (carry * 0x8005U) ^ (high << 8 | low);
  }
  return {static_cast<char>(sum & 0xff), static_cast<char>(sum >> 8)};
}

void appendWord(std::string& bytes, unsigned word) {
  bytes += static_cast<char>(word & 0xff);
  bytes += static_cast<char>(word >> 8 & 0xff);
}

unsigned digitOf(float range) {
  if (!std::isfinite(range) || range > 0.001F * kFarthest) return kNoEcho;
  return static_cast<unsigned>(std::lround(1000.0F * std::max(range, 0.0F)));
}

}  // namespace

void LmsEmulator::answer(std::string payload) {
  payload += kStatus;
  std::string frame("\x02\x80", 2);
  appendWord(frame, static_cast<unsigned>(payload.size()));
  frame += payload;
  out_ += frame + checksumOf(frame);
}

void LmsEmulator::receive(std::string_view bytes, int64_t /*utime*/) {
  in_.append(bytes.substr(0, 4096));
  for (;;) {
    in_.erase(0, std::min(in_.find(std::string("\x02\x00", 2)), in_.size()));
    if (in_.size() < 4) return;
    const size_t length =
        static_cast<unsigned char>(in_[2]) + 256U * static_cast<unsigned char>(in_[3]);
    if (length == 0 || length > 64) {
      in_.erase(0, 1);
      continue;
    }
    if (in_.size() < length + 6) return;
    const std::string frame = in_.substr(0, length + 4);
    const bool good = checksumOf(frame) == in_.substr(length + 4, 2);
    in_.erase(0, good ? length + 6 : 1);
    if (faults_.silent) continue;
    out_ += good ? kAcknowledge : kRefuse;
    if (good) run(frame.substr(4));
  }
}

void LmsEmulator::run(const std::string& command) {
  const char kind = command[0];
  if (kind == 0x20 && command.size() == 2 && (command[1] == 0x24 || command[1] == 0x25)) {
    streaming_ = command[1] == 0x24;
    answer(std::string("\xA0\x00", 2));
  } else if (kind == 0x3B && command.size() == 5) {
    const bool known = command[1] == char(180) && (command[3] == 100 || command[3] == 50);
    if (known) per_degree_ = command[3] == 50 ? 2 : 1;
    answer(std::string("\xBB") + (known ? '\x01' : '\x00') + command.substr(1));
  } else if (kind == 0x74) {
    // Blanking, threshold, availability, measuring mode 0 (13 bits), mm, and the rest.
    answer("\xF4" + std::string("\x00\x00\x00\x00\x00\x01", 6) + std::string(27, '\0'));
  } else if (kind == 0x31) {
    answer("\xB1" + std::string(151, '\0'));
  } else {
    answer("\x92");
  }
}

void LmsEmulator::add(const LaserScan& scan) {
  if (!streaming_ || faults_.silent) return;
  const int count = 180 * per_degree_ + 1;
  std::string payload("\xB0");
  appendWord(payload, static_cast<unsigned>(count) | 1U << 14);
  const double step = laser_.field_of_view / (laser_.beams - 1);
  for (int i = 0; i < count; ++i) {
    const double angle = (static_cast<double>(i) / per_degree_ - 90.0) * kPi / 180.0;
    const long beam = std::lround((angle + laser_.field_of_view / 2.0) / step);
    const bool seen = beam >= 0 && beam < static_cast<long>(scan.ranges.size());
    appendWord(payload, digitOf(seen ? scan.ranges[static_cast<size_t>(beam)] : NAN));
  }
  const size_t before = out_.size();
  answer(payload);
  const size_t length = out_.size() - before;
  if (faults_.bad_checksum) out_.back() = static_cast<char>(out_.back() ^ 1);
  if (faults_.dropped_byte) out_.erase(before + length / 2, 1);
  if (faults_.half_frame) out_.resize(before + length / 2);
}

std::string LmsEmulator::transmit(int64_t /*utime*/) {
  return std::exchange(out_, {});
}

void LmsEmulator::reboot() {
  in_.clear();
  out_.clear();
  streaming_ = false;
  per_degree_ = 1;
}

}  // namespace tread::sim
