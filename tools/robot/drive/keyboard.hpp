// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>
#include <string_view>

#include "tools/robot/drive/stick.hpp"

namespace tread::drive {

/// What the keys of a terminal say, which tells no release: a key counts as held as long as its
/// repetitions come.
class KeyState {
 public:
  void take(std::string_view bytes, int64_t now);
  Wishes wishes(int64_t now) const;

 private:
  static constexpr int64_t kHeld = 200'000;      ///< [us] without a repetition
  static constexpr int64_t kArming = 2'500'000;  ///< [us] that an arming by hand takes at most
  static constexpr int64_t kEscape = 50'000;     ///< [us] after which ESC was a key of its own
  /// Whether ESC was a key of its own: an arrow's other bytes would have come.
  bool escapedAlone(int64_t now) const { return escape_ != 0 && now - escaped_at_ >= kEscape; }
  void press(char key, int64_t now);
  void move(double forward, double turn, int64_t now);

  int escape_ = 0;          ///< characters of an escape sequence so far; 3: more than an arrow has
  int64_t escaped_at_ = 0;  ///< [us] of its first one
  double forward_ = 0.0;
  double turn_ = 0.0;
  int64_t moves_until_ = 0;  ///< [us]
  int64_t holds_until_ = 0;
  int64_t stops_until_ = 0;
  int64_t arms_until_ = 0;
  int64_t disarms_until_ = 0;
  int64_t gives_back_until_ = 0;
};

/// The terminal that the program runs in, without echo and line by line reading as long as this
/// lives.
class Keyboard : public Stick {
 public:
  /// Throws std::runtime_error where standard input is no terminal.
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
