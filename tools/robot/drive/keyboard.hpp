// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>
#include <string_view>

#include "tools/robot/drive/stick.hpp"

namespace tread::drive {

/// State of a terminal's keys. A terminal reports no key release, so a key counts as held as long
/// as it repeats.
class KeyState {
 public:
  void take(std::string_view bytes, int64_t now);
  Wishes wishes(int64_t now) const;

 private:
  /// [us] a key counts as held after its last repetition
  static constexpr int64_t kHeld = 200'000;
  /// [us] longest duration of an arming for manual control
  static constexpr int64_t kArming = 2'500'000;
  static constexpr int64_t kEscape = 50'000;  ///< [us] after which a lone ESC byte is the ESC key
  /// Whether the ESC byte was the ESC key: the other bytes of an arrow key would have arrived by
  /// now.
  bool escapedAlone(int64_t now) const { return escape_ != 0 && now - escaped_at_ >= kEscape; }
  void press(char key, int64_t now);
  void move(double forward, double turn, int64_t now);

  int escape_ = 0;          ///< bytes of an escape sequence so far; 3: longer than an arrow key's
  int64_t escaped_at_ = 0;  ///< [us] of its first byte
  double forward_ = 0.0;
  double turn_ = 0.0;
  int64_t moves_until_ = 0;  ///< [us]
  int64_t holds_until_ = 0;
  int64_t stops_until_ = 0;
  int64_t arms_until_ = 0;
  int64_t disarms_until_ = 0;
  int64_t gives_back_until_ = 0;
};

/// The terminal of this process, without echo and line buffering while this object lives.
class Keyboard : public Stick {
 public:
  /// Throws std::runtime_error if standard input is not a terminal.
  Keyboard();
  ~Keyboard() override;

  Wishes read(int64_t now) override;
  std::string name() const override { return "keyboard"; }
  std::string keys() const override;

 private:
  struct Terminal;
  std::unique_ptr<Terminal> terminal_;
  KeyState state_;
};

}  // namespace tread::drive
