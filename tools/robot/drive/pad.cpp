// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/drive/pad.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

#include <linux/input.h>

namespace tread::drive {
namespace {

constexpr double kDeadZone = 0.12;  // of the deflection from the centre

}  // namespace

TrackCommand mixed(double forward, double turn) {
  const double left = forward - turn;
  const double right = forward + turn;
  const double most = std::max({1.0, std::abs(left), std::abs(right)});
  return {left / most, right / most};
}

void PadState::setRange(int code, int least, int most) {
  if (most <= least) return;
  axes_[code].least = least;
  axes_[code].most = most;
}

void PadState::begin(int type, int code, int value) {
  if (type == EV_ABS) axes_[code].value = value;
  if (type == EV_KEY) pressed_[code] = value != 0;
}

void PadState::take(int type, int code, int value) {
  if (type == EV_ABS) {
    const std::optional<int> before = axes_[code].value;
    axes_[code].measured |= before && *before != value;
  }
  begin(type, code, value);
}

double PadState::share(const Axis& axis) {
  if (!axis.measured) return std::numeric_limits<double>::quiet_NaN();
  const double half = 0.5 * (static_cast<double>(axis.most) - axis.least);
  const double way =
      std::clamp((static_cast<double>(*axis.value) - axis.least) / half - 1.0, -1.0, 1.0);
  const double beyond = std::max(0.0, std::abs(way) - kDeadZone) / (1.0 - kDeadZone);
  return std::copysign(beyond, way);
}

bool PadState::anyPressed(std::initializer_list<int> buttons) const {
  return std::any_of(buttons.begin(), buttons.end(), [this](int button) {
    const auto found = pressed_.find(button);
    return found != pressed_.end() && found->second;
  });
}

Wishes PadState::wishes() const {
  const auto at = [this](int code) {
    const auto found = axes_.find(code);
    return -share(found == axes_.end() ? Axis{} : found->second);  // up and left are negative
  };
  Wishes wishes;
  wishes.forward = at(ABS_Y);
  wishes.turn = at(ABS_X);
  wishes.hold = anyPressed({BTN_TL, BTN_TR, BTN_TRIGGER});
  wishes.arm = anyPressed({BTN_START, BTN_BASE});
  wishes.disarm = anyPressed({BTN_SELECT, BTN_BASE2});
  wishes.give_back = anyPressed({BTN_NORTH, BTN_WEST, BTN_THUMB});
  return wishes;
}

RecordedPad::RecordedPad(const std::string& path) : path_(path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path + ": cannot be read");
  std::string line;
  for (int number = 1; std::getline(file, line); ++number)
    takeLine(line, path + ":" + std::to_string(number) + ": ");
  if (events_.empty())
    throw std::runtime_error(path +
                             ": holds no event (lines that begin with E:), as evemu-record "
                             "writes them");
}

void RecordedPad::takeLine(const std::string& line, const std::string& where) {
  std::istringstream words(line);
  std::string kind;
  words >> kind;
  if (kind == "A:") {
    int code = 0;
    int least = 0;
    int most = 0;
    if (!(words >> std::hex >> code >> std::dec >> least >> most))
      throw std::runtime_error(where + "an axis is written A: code least most, as 'A: 00 0 255'");
    state_.setRange(code, least, most);
  }
  if (kind != "E:") return;
  int64_t seconds = 0;
  int64_t micros = 0;
  char dot = 0;
  Event event{};
  if (!(words >> seconds >> dot >> micros >> std::hex >> event.type >> event.code >> std::dec >>
        event.value) ||
      dot != '.' || seconds < 0 || seconds > 1'000'000'000'000 || micros < 0 || micros > 999'999)
    throw std::runtime_error(where +
                             "an event is written E: seconds.micros type code value, as "
                             "'E: 0.020000 0003 0001 128'");
  const int64_t time = seconds * 1'000'000 + micros;
  if (first_ < 0) first_ = time;
  if (!events_.empty() && time - first_ < events_.back().time)
    throw std::runtime_error(where + "goes back in time");
  event.time = time - first_;
  events_.push_back(event);
}

Wishes RecordedPad::read(int64_t now) {
  if (begun_ < 0) begun_ = now;
  for (; next_ < events_.size() && events_[next_].time <= now - begun_; ++next_) {
    const Event& event = events_[next_];
    // The kernel reports the state at opening first.
    if (event.time == 0)
      state_.begin(event.type, event.code, event.value);
    else
      state_.take(event.type, event.code, event.value);
  }
  Wishes wishes = state_.wishes();
  wishes.ended = next_ == events_.size();
  return wishes;
}

}  // namespace tread::drive
