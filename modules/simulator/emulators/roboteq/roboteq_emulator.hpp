// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>

#include "modules/simulator/emulators/roboteq/roboteq_firmware.hpp"

namespace tread::sim {

/// One direction of a serial line: bytes arrive one after the other at the line's speed.
class SerialLine {
 public:
  /// 10 bits a byte: 8N1.
  explicit SerialLine(int baud) : byte_ns_(10'000'000'000LL / baud) {}

  /// Puts bytes on the line at a time [us].
  void send(std::string_view bytes, int64_t utime) {
    for (char byte : bytes) {
      const int64_t start = std::max(free_ns_, utime * 1000);
      free_ns_ = start + byte_ns_;
      bytes_.push_back({byte, (free_ns_ + 999) / 1000});
    }
  }

  struct Byte {
    char value;
    int64_t utime;  ///< when its stop bit has passed
  };

  /// True if a byte has arrived by a time; then front() is the first of them.
  bool arrived(int64_t utime) const { return !bytes_.empty() && bytes_.front().utime <= utime; }
  const Byte& front() const { return bytes_.front(); }
  void pop() { bytes_.pop_front(); }

  /// All bytes that have arrived by a time.
  std::string takeArrived(int64_t utime) {
    std::string out;
    for (; arrived(utime); pop()) out += front().value;
    return out;
  }

  /// Drops what is on its way.
  void clear() { bytes_.clear(); }

 private:
  int64_t byte_ns_;
  int64_t free_ns_ = 0;  ///< when the last byte has passed
  std::deque<Byte> bytes_;
};

/// A Roboteq controller at the end of a serial line: paced bytes, echo, line ends, faults.
/** Lines end with CR or '_'; other characters below space are ignored. Echo is on after power-up:
   each character comes back before the reply. */
class RoboteqEmulator final : public MotorEmulator {
 public:
  explicit RoboteqEmulator(const RoboteqSettings& settings = {});

  void receive(std::string_view bytes, int64_t utime) override;
  std::string transmit(int64_t utime) override;
  std::array<double, 2> output(int64_t utime) override;
  void measure(const DriveMeasurements& measurements) override { firmware_.measure(measurements); }

  // Faults.
  /// The next n replies (not echoes) never come.
  void loseReplies(int n) { lost_replies_ = n; }
  /// The next reply breaks off in the middle, without its CR.
  void cutReply() { cut_reply_ = true; }
  /// The controller's logic supply fails and returns: deaf for a while, then the power-up state.
  void reboot(int64_t utime);
  /// The motor supply drops below what the power stage needs, or recovers.
  void setBrownOut(bool active) { firmware_.setBrownOut(active); }
  /// Hears nothing and says nothing; the watchdog goes on.
  void setSilent(bool silent) { silent_ = silent; }

 private:
  void advance(int64_t utime);
  void hear(char byte, int64_t utime);
  void endLine(int64_t utime);
  void reply(const std::string& line, int64_t utime);

  RoboteqSettings settings_;
  RoboteqFirmware firmware_;
  SerialLine from_robot_;
  SerialLine to_robot_;
  std::string line_;
  int64_t deaf_until_ = INT64_MIN;
  int lost_replies_ = 0;
  bool cut_reply_ = false;
  bool silent_ = false;
};

}  // namespace tread::sim
