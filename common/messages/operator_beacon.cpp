// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/messages/operator_beacon.hpp"

#include <cmath>
#include <cstdlib>
#include <utility>

#include "common/messages/blank.hpp"
#include "common/report/text.hpp"

namespace tread {
namespace {

constexpr size_t kLongestName = 64;
constexpr int64_t kLeaves = 1'000'000;      // [us] of silence
constexpr int64_t kWorthTelling = 100'000;  // [us]

/// Names appear in terminal output.
bool canBeShown(const std::string& name) {
  return name.size() <= kLongestName && std::none_of(name.begin(), name.end(), [](char c) {
           return static_cast<unsigned char>(c) < ' ' || c == '\x7f';
         });
}

}  // namespace

std::optional<OperatorNotice> noticeFrom(const operator_t& message) {
  if (message.operator_name.empty() || !canBeShown(message.operator_name) ||
      !canBeShown(message.hand_over_to))
    return std::nullopt;
  return OperatorNotice{
      message.station,    message.operator_name, message.allowed == operator_t::ALLOW_DRIVING,
      message.seen_utime, message.stands_for,    message.hand_over_to};
}

HolderWatch::HolderWatch(Bus& bus) {
  bus.subscribe<motor_t>(kMotor, [this](const motor_t& motor) {
    told_ = motor.utime;
    name_ = motor.holder;
  });
}

OperatorBeacon::OperatorBeacon(Bus& bus, std::string name)
    : bus_(bus), name_(std::move(name)), station_(bus.newStation()) {
  bus_.subscribe<motor_t>(kMotor, [this](const motor_t& message) {
    clock_.observe(message.utime, bus_.now());
    seen_utime_ = std::max(seen_utime_, message.utime);
  });
  bus_.overhear<operator_t>(kOperator, [this](const operator_t& message) {
    if (message.operator_name != name_ || message.station == station_) return;
    namesake_ =
        message.allowed == operator_t::ALLOW_NOTHING ? std::nullopt : std::optional(bus_.now());
  });
}

void OperatorBeacon::step(int64_t utime) {
  if (utime < next_ || !hearsRobot()) return;
  next_ = utime + kPeriod;
  send(utime, operator_t::ALLOW_DRIVING);
}

void OperatorBeacon::letGo(int64_t utime) {
  // Repeated, because one lost message would look like a lost operator.
  for (int i = 0; i < 3 && hearsRobot(); ++i) send(utime, operator_t::ALLOW_NOTHING);
}

void OperatorBeacon::send(int64_t utime, int16_t allowed) {
  auto message = blank<operator_t>();
  message.utime = robotTime(utime);
  message.seq = seq_++;
  message.station = station_;
  message.operator_name = name_;
  message.allowed = allowed;
  message.seen_utime = seen_utime_;
  message.stands_for = goal_id_;
  message.hand_over_to = hand_over_to_;
  bus_.publish(kOperator, message);
}

std::string OperatorBeacon::namesakeWords(int64_t utime) const {
  if (!namesake_ || utime - *namesake_ > kLeaves) return "";
  return "; another program of " + name_ +
         " holds the robot, too: if it is somebody else's, tell the two of you apart by --operator";
}

std::string OperatorBeacon::clockWords() const {
  const int64_t offset = clock_.offset().value_or(0);
  if (std::abs(offset) < kWorthTelling) return "";
  return formatted("; the robot's clock is %.1f s ", std::abs(static_cast<double>(offset)) * 1e-6) +
         (offset > 0 ? "ahead of" : "behind") + " this machine's, which is taken into account";
}

}  // namespace tread
