// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/emulators/sick_cola/cola_emulator.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace tread::sim {
namespace {

constexpr size_t kMostInput = 4096;
constexpr int64_t kSending = 1000;  // [us] from the last beam to the transmission

/// Writes fields in either dialect.
class Writer {
 public:
  explicit Writer(bool binary) : binary_(binary) {}

  void number(uint32_t value, int bits) {
    if (binary_) {
      for (int shift = bits - 8; shift >= 0; shift -= 8)
        text_ += static_cast<char>(value >> shift & 0xff);
    } else {
      char digits[12];
      std::snprintf(digits, sizeof digits, " %X", value);
      text_ += digits;
    }
  }
  void name(const std::string& name) { text_ += (binary_ ? "" : " ") + name; }
  const std::string& text() const { return text_; }

 private:
  bool binary_;
  std::string text_;
};

bool begins(const std::string& text, const std::string& with) {
  return text.compare(0, with.size(), with) == 0;
}

uint32_t digitOf(float range) {
  if (!std::isfinite(range)) return 0;
  return static_cast<uint32_t>(std::clamp(1000.0F * range, 0.0F, 65535.0F) + 0.5F);
}

uint32_t tenThousandths(double radians) {
  return static_cast<uint32_t>(std::lround(radians * 1'800'000.0 / kPi));
}

}  // namespace

void ColaEmulator::receive(std::string_view bytes, int64_t /*utime*/) {
  in_.append(bytes.substr(0, std::min(bytes.size(), kMostInput)));
  std::string telegram;
  bool binary = false;
  while (next(telegram, binary))
    if (!faults_.silent) run(telegram, binary);
  if (in_.size() > kMostInput) in_.clear();
}

bool ColaEmulator::next(std::string& telegram, bool& binary) {
  in_.erase(0, std::min(in_.find('\x02'), in_.size()));
  binary = begins(in_, "\x02\x02\x02\x02");
  if (binary) {
    if (in_.size() < 9) return false;
    const auto length = static_cast<size_t>(static_cast<unsigned char>(in_[7])) +
                        256 * static_cast<size_t>(static_cast<unsigned char>(in_[6]));
    if (in_.size() < 9 + length) return false;
    telegram = in_.substr(8, length);
    in_.erase(0, 9 + length);
    return true;
  }
  const size_t end = in_.find('\x03');
  if (end == std::string::npos) return false;
  telegram = in_.substr(1, end - 1);
  in_.erase(0, end + 1);
  return true;
}

void ColaEmulator::run(const std::string& telegram, bool binary) {
  const auto answer = [&](const std::string& words, char code) {
    const std::string tail = binary ? std::string(1, code) : std::string(1, char('0' + code));
    out_ += frame(words + " " + tail, binary);
  };
  if (begins(telegram, "sRN DeviceIdent")) {
    out_ += frame("sRA DeviceIdent 10 LMS10x_FieldEval 10 V1.36-21.10.2010", binary);
  } else if (begins(telegram, "sMN SetAccessMode")) {
    const std::string word = binary ? "\xF4\x72\x47\x44" : "F4724744";
    logged_in_ = telegram.find(word) != std::string::npos;
    answer("sAN SetAccessMode", logged_in_ ? 1 : 0);
  } else if (begins(telegram, "sMN LMCstartmeas") && logged_in_) {
    answer("sAN LMCstartmeas", 0);
  } else if (begins(telegram, "sMN Run")) {
    logged_in_ = false;
    answer("sAN Run", 1);
  } else if (begins(telegram, "sEN LMDscandata ") && telegram.size() == 17) {
    streaming_ = telegram[16] == (binary ? '\x01' : '1');
    binary_ = binary;
    answer("sEA LMDscandata", streaming_ ? 1 : 0);
  } else {
    answer("sFA", 3);
  }
}

std::string ColaEmulator::frame(const std::string& telegram, bool binary) const {
  if (!binary) return "\x02" + telegram + "\x03";
  std::string framed("\x02\x02\x02\x02", 4);
  char sum = 0;
  for (int shift = 24; shift >= 0; shift -= 8)
    framed += static_cast<char>(telegram.size() >> shift & 0xff);
  for (const char byte : telegram) sum = static_cast<char>(sum ^ byte);
  return framed + telegram + sum;
}

std::string ColaEmulator::scanTelegram(const LaserScan& scan) {
  Writer fields(binary_);
  const int64_t last_beam = scan.utime + laser_.sweep_us;
  fields.number(1, 16);         // version
  fields.number(1, 16);         // device
  fields.number(0x89A27F, 32);  // serial number
  fields.number(0, 8);          // status
  fields.number(0, 8);          // status
  fields.number(++telegrams_, 16);
  fields.number(telegrams_, 16);  // scans
  fields.number(static_cast<uint32_t>(last_beam - power_on_), 32);
  fields.number(static_cast<uint32_t>(last_beam + kSending - power_on_), 32);
  for (const uint32_t pins : {0U, 0U, 7U, 0U}) fields.number(pins, 8);
  fields.number(0, 16);  // layer
  const double turn = static_cast<double>(laser_.sweep_us) * 2.0 * kPi / laser_.field_of_view;
  fields.number(static_cast<uint32_t>(std::lround(1e8 / turn)), 32);
  fields.number(0x168, 32);  // measuring frequency
  fields.number(0, 16);      // encoders
  fields.number(1, 16);      // channels of 16 bits
  fields.name("DIST1");
  fields.number(0x3F800000, 32);  // scale 1
  fields.number(0, 32);           // offset 0
  const double step = laser_.field_of_view / (laser_.beams - 1);
  fields.number(tenThousandths(kPi / 2.0 - laser_.field_of_view / 2.0), 32);
  fields.number(tenThousandths(step), 16);
  fields.number(static_cast<uint32_t>(scan.ranges.size()), 16);
  for (const float range : scan.ranges) fields.number(digitOf(range), 16);
  // Channels of 8 bits, position, name, comment, time, event: none.
  for (int i = 0; i < 6; ++i) fields.number(0, 16);
  return std::string("sSN LMDscandata") + (binary_ ? " " : "") + fields.text();
}

void ColaEmulator::add(const LaserScan& scan) {
  if (!streaming_ || faults_.silent) return;
  std::string framed =
      faults_.repeats ? last_scan_ : last_scan_ = frame(scanTelegram(scan), binary_);
  if (faults_.bad_checksum && !framed.empty()) framed.back() = static_cast<char>(framed.back() ^ 1);
  if (faults_.dropped_byte) framed.erase(framed.size() / 2, 1);
  if (faults_.half_telegram) framed.erase(framed.size() / 2);
  out_ += framed;
}

std::string ColaEmulator::transmit(int64_t /*utime*/) {
  return std::exchange(out_, {});
}

void ColaEmulator::reconnect() {
  in_.clear();
  out_.clear();
  streaming_ = logged_in_ = false;
}

void ColaEmulator::reboot(int64_t utime) {
  reconnect();
  power_on_ = utime;
  telegrams_ = 0;
}

}  // namespace tread::sim
