// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>

#include "modules/simulator/emulators/emulator.hpp"

namespace tread::sim {

/// One direction of a serial line: bytes arrive one by one at the line's speed.
class SerialLine {
 public:
  /// 10 bits a byte: 8N1.
  explicit SerialLine(int baud) : byte_ns_(10'000'000'000LL / baud) {}

  /// Sends bytes at a time [us].
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

  /// time of the end of its stop bit
  bool arrived(int64_t utime) const { return !bytes_.empty() && bytes_.front().utime <= utime; }
  const Byte& front() const { return bytes_.front(); }
  void pop() { bytes_.pop_front(); }

  /// Whether a byte has arrived by a time; then front() is the first of them.
  std::string takeArrived(int64_t utime) {
    std::string out;
    for (; arrived(utime); pop()) out += front().value;
    return out;
  }

  /// Drops bytes in transit.
  void clear() { bytes_.clear(); }

 private:
  int64_t byte_ns_;
  int64_t free_ns_ = 0;  ///< time of the end of the last byte
  std::deque<Byte> bytes_;
};

/// Common part of motor controllers at the end of a serial line: byte timing and faults.
class SerialMotorEmulator : public MotorEmulator {
 public:
  void receive(std::string_view bytes, int64_t utime) override;
  std::string transmit(int64_t utime) override;

  // Faults.
  /// The next n replies (not echoes) are lost.
  void loseReplies(int n) { lost_replies_ = n; }
  /// The next reply breaks off in the middle.
  void cutReply() { cut_reply_ = true; }
  /// Flips a bit in the middle of the next reply.
  void garbleReply() { garble_reply_ = true; }
  /// The controller's logic supply fails and returns: no communication for a while, then the
  /// power-up state.
  void reboot(int64_t utime);
  /// Receives and sends nothing; the watchdog keeps running.
  void setSilent(bool silent) { silent_ = silent; }

 protected:
  /// `reply_delay_us`: from the end of a request to the first byte of its reply; `boot_us`: no
  /// communication after a reboot.
  SerialMotorEmulator(int baud, int64_t reply_delay_us, int64_t boot_us)
      : from_robot_(baud), to_robot_(baud), reply_delay_us_(reply_delay_us), boot_us_(boot_us) {}

  /// Advances the firmware to a time.
  virtual void run(int64_t utime) = 0;
  /// Resets to the power-up state; messages sent then leave from this time on.
  virtual void powerUp(int64_t utime) = 0;
  virtual void hear(char byte, int64_t utime) = 0;

  void advance(int64_t utime);
  /// Sends bytes at once, without the faults of replies.
  void say(std::string_view bytes, int64_t utime) { to_robot_.send(bytes, utime); }
  void reply(std::string bytes, int64_t utime);

 private:
  SerialLine from_robot_;
  SerialLine to_robot_;
  int64_t reply_delay_us_;
  int64_t boot_us_;
  int64_t deaf_until_ = INT64_MIN;
  int lost_replies_ = 0;
  bool cut_reply_ = false;
  bool garble_reply_ = false;
  bool silent_ = false;
};

}  // namespace tread::sim
