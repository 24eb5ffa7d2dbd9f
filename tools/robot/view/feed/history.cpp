// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/view/feed/history.hpp"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "common/messages/ins_messages.hpp"

namespace tread::view {
namespace {

using Json = nlohmann::json;

constexpr double kWayStep = 0.15;            // [m] spacing at the beginning
constexpr double kWayPoints = 5000.0;        // number of points from which on the spacing grows
constexpr int64_t kBatteryStep = 2'000'000;  // [us]

constexpr size_t kMostWords = 400;  // [bytes] of an event

template <class List>
void keepNewest(List& list, size_t most, size_t& told) {
  if (list.size() < 2 * most) return;
  const size_t dropped = list.size() - most;
  list.erase(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(dropped));
  told -= std::min(told, dropped);
}

/// JSON has no number for unknown values.
Json numberOr(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

}  // namespace

void History::forgetOldest() {
  keepNewest(events_, most_, told_.events);
  keepNewest(patterns_, most_, told_.patterns);
  keepNewest(way_, most_, told_.way);
  keepNewest(battery_, most_, told_.battery);
}

void History::take(const LogEvent& event) {
  forgetOldest();
  for (Event& told : teller_.take(event)) {
    told.words.resize(std::min(told.words.size(), kMostWords));
    events_.push_back(std::move(told));
  }
  ins_t ins;
  motor_t motor;
  learning_t learning;
  if (decode(event, kIns, ins)) {
    const auto pose = planarPose(ins);
    const double step = kWayStep * std::max(1.0, static_cast<double>(way_.size()) / kWayPoints);
    if (pose &&
        (way_.empty() || std::hypot(way_.back().a - pose->x, way_.back().b - pose->y) > step))
      way_.push_back({event.utime, pose->x, pose->y});
  } else if (decode(event, kMotor, motor)) {
    if (std::isfinite(motor.battery_voltage) &&
        (battery_.empty() || event.utime - battery_.back().utime >= kBatteryStep))
      battery_.push_back({event.utime, static_cast<double>(motor.battery_voltage), 0.0});
  } else if (decode(event, kLearning, learning)) {
    patterns_.push_back({event.utime, std::move(learning)});
  }
}

std::string History::since(const Mark& mark, bool from_start) const {
  Json events = Json::array(), patterns = Json::array(), way = Json::array(),
       battery = Json::array();
  for (size_t i = mark.events; i < events_.size(); ++i) {
    const Event& event = events_[i];
    events.push_back({event.utime, static_cast<int>(event.severity), event.source, event.words});
  }
  for (size_t i = mark.patterns; i < patterns_.size(); ++i) {
    const learning_t& ended = patterns_[i].ended;
    patterns.push_back({patterns_[i].utime, ended.learned_pattern_name, ended.accepted != 0,
                        numberOr(ended.error_position), numberOr(ended.error_yaw), ended.surface,
                        numberOr(ended.ground_changed), ended.changed != 0, wordsOf(ended)});
  }
  for (size_t i = mark.way; i < way_.size(); ++i)
    way.push_back(
        {way_[i].utime, std::round(way_[i].a * 1e3) / 1e3, std::round(way_[i].b * 1e3) / 1e3});
  for (size_t i = mark.battery; i < battery_.size(); ++i)
    battery.push_back({battery_[i].utime, battery_[i].a});
  return Json{{"from_start", from_start},
              {"events", events},
              {"patterns", patterns},
              {"way", way},
              {"battery", battery}}
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string History::whole() const {
  return since({}, true);
}

std::string History::news() {
  const Mark before = told_;
  told_ = end();
  return before == told_ ? "" : since(before, false);
}

}  // namespace tread::view
