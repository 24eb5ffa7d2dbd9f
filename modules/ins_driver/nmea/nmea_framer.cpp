// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/nmea/nmea_framer.hpp"

namespace tread::ins {
namespace {

/// '$', CR and LF.
constexpr size_t kFraming = 3;

/// Value of a hexadecimal digit, or -1.
int hexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

bool printable(char c) {
  return c >= 0x20 && c <= 0x7E;
}

}  // namespace

uint8_t nmeaChecksum(std::string_view body) {
  uint8_t sum = 0;
  for (const char c : body) sum = static_cast<uint8_t>(sum ^ static_cast<uint8_t>(c));
  return sum;
}

std::optional<std::string_view> NmeaFramer::push(char byte) {
  if (byte == '$') {
    interrupt();
    inside_ = true;
    line_.clear();
    ++sentences_;
    return std::nullopt;
  }
  const bool line_end = byte == '\r' || byte == '\n';
  if (!inside_) {
    if (!line_end) ++stray_bytes_;
    return std::nullopt;
  }
  if (line_end) return endOfLine();
  if (!printable(byte)) {
    refuse(SentenceRefusal::kNotPrintable);
  } else if (line_.size() + kFraming >= kMaxLength) {
    refuse(SentenceRefusal::kTooLong);
  } else {
    line_.push_back(byte);
  }
  return std::nullopt;
}

void NmeaFramer::interrupt() {
  if (inside_) refuse(SentenceRefusal::kCut);
}

void NmeaFramer::refuse(SentenceRefusal reason) {
  refusals_.add(reason);
  inside_ = false;
}

std::optional<std::string_view> NmeaFramer::endOfLine() {
  const std::string_view line = line_;
  const size_t star = line.find('*');
  const bool at_its_place = star != std::string_view::npos && star + 3 == line.size();
  const int high = at_its_place ? hexDigit(line[star + 1]) : -1;
  const int low = at_its_place ? hexDigit(line[star + 2]) : -1;
  if (high < 0 || low < 0) {
    refuse(SentenceRefusal::kNoChecksum);
    return std::nullopt;
  }
  const std::string_view body = line.substr(0, star);
  if (nmeaChecksum(body) != high * 16 + low) {
    refuse(SentenceRefusal::kWrongChecksum);
    return std::nullopt;
  }
  inside_ = false;
  return body;
}

}  // namespace tread::ins
