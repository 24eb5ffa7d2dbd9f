// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/core/line_cutter.hpp"

namespace tread::motor {

std::vector<std::string> LineCutter::push(std::string_view bytes) {
  std::vector<std::string> lines;
  for (const char byte : bytes) {
    if (byte == end_) {
      if (!line_.empty() && !discarding_) lines.push_back(line_);
      line_.clear();
      discarding_ = false;
    } else if (byte < ' ' || byte > '~') {
      garbage_ += byte != '\n' && byte != '\r';
    } else if (line_.size() == kMaxLine) {
      overlong_ += !discarding_;
      discarding_ = true;
    } else {
      line_ += byte;
    }
  }
  return lines;
}

void LineCutter::clear() {
  line_.clear();
  discarding_ = false;
}

}  // namespace tread::motor
