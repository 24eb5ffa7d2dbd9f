// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/drive/keyboard.hpp"

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include <termios.h>
#include <unistd.h>

namespace tread::drive {

void KeyState::take(std::string_view bytes, int64_t now) {
  if (escapedAlone(now)) {
    escape_ = 0;
    press(' ', escaped_at_);
  }
  for (const char byte : bytes) {
    if (byte == '\x1b') {
      escape_ = 1;
      escaped_at_ = now;
    } else if (escape_ == 1 && (byte == '[' || byte == 'O')) {
      escape_ = 2;
    } else if (escape_ >= 2 && byte >= ' ' && byte <= '?') {
      escape_ = 3;  // Shift, Ctrl or Alt is held, or a function key
    } else if (escape_ == 3) {
      escape_ = 0;
      press(' ', now);
    } else if (escape_ == 2) {
      escape_ = 0;
      constexpr std::string_view kArrows = "ABDC";  // up, down, left, right
      const size_t arrow = kArrows.find(byte);
      press(arrow != std::string_view::npos ? "wsad"[arrow] : ' ', now);
    } else {
      escape_ = 0;
      press(byte, now);
    }
  }
}

void KeyState::move(double forward, double turn, int64_t now) {
  forward_ = forward;
  turn_ = turn;
  moves_until_ = now + kHeld;
}

void KeyState::press(char key, int64_t now) {
  const double share = key >= 'A' && key <= 'Z' ? 1.0 : 0.5;  // of the full deflection
  switch (key) {
    case 'w':
    case 'W':
      return move(share, 0.0, now);
    case 's':
    case 'S':
      return move(-share, 0.0, now);
    case 'a':
    case 'A':
      return move(0.0, share, now);
    case 'd':
    case 'D':
      return move(0.0, -share, now);
    case 'q':
    case 'Q':
      return move(share, 0.4 * share, now);
    case 'e':
    case 'E':
      return move(share, -0.4 * share, now);
    case '\r':
    case '\n':
      arms_until_ = now + kHeld;
      holds_until_ = now + kArming;
      return;
    case '\x7f':
    case '\b':
      disarms_until_ = now + kHeld;
      return;
    case 'g':
      gives_back_until_ = now + kHeld;
      return;
    default:  // space and every unassigned key stop
      moves_until_ = holds_until_ = now;
      stops_until_ = now + kHeld;
  }
}

Wishes KeyState::wishes(int64_t now) const {
  Wishes wishes;
  const bool escaped = escapedAlone(now);
  const bool moves = now < moves_until_ && !escaped;
  // "No key pressed" is a valid measurement.
  wishes.forward = moves ? forward_ : 0.0;
  wishes.turn = moves ? turn_ : 0.0;
  wishes.hold = moves || (now < holds_until_ && !escaped);
  wishes.arm = now < arms_until_;
  wishes.stop = now < stops_until_ || (escaped && now < escaped_at_ + kEscape + kHeld);
  wishes.disarm = now < disarms_until_;
  wishes.give_back = now < gives_back_until_;
  return wishes;
}

struct Keyboard::Terminal {
  termios before{};
};

Keyboard::Keyboard() : terminal_(std::make_unique<Terminal>()) {
  if (::tcgetattr(STDIN_FILENO, &terminal_->before) != 0)
    throw std::runtime_error("the keyboard is read from a terminal, but standard input is not one");
  termios raw = terminal_->before;
  raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  raw.c_cc[VMIN] = 0;
  raw.c_cc[VTIME] = 0;
  // Disable Ctrl-Z and Ctrl-\: both would leave the terminal without echo.
  raw.c_cc[VSUSP] = raw.c_cc[VQUIT] = _POSIX_VDISABLE;
  if (::tcsetattr(STDIN_FILENO, TCSANOW, &raw) != 0)
    throw std::runtime_error(std::string("the terminal: ") + std::strerror(errno));
}

Keyboard::~Keyboard() {
  ::tcsetattr(STDIN_FILENO, TCSANOW, &terminal_->before);
}

Wishes Keyboard::read(int64_t now) {
  char bytes[256];
  const ssize_t size = ::read(STDIN_FILENO, bytes, sizeof bytes);
  if (size < 0 && errno != EAGAIN && errno != EINTR)
    throw std::runtime_error(std::string("the terminal is gone: ") + std::strerror(errno));
  if (size > 0) state_.take({bytes, static_cast<size_t>(size)}, now);
  return state_.wishes(now);
}

std::string Keyboard::keys() const {
  return "hold an arrow or w a s d, q e for curves, with Shift W A S D Q E at full power; space "
         "stops, Enter arms, Backspace disarms, g gives back; Ctrl-C ends";
}

}  // namespace tread::drive
