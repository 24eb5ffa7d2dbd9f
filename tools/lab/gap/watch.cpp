// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/gap/watch.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <stdexcept>
#include <utility>
#include <vector>

#include "common/soundness/core/log_validation.hpp"
#include "common/soundness/drive_log.hpp"

namespace tread::gap {
namespace {

constexpr int64_t kBefore = 8'000'000;    // [us] before a reading, to determine its entry motion
constexpr int64_t kBehind = 1'500'000;    // [us] after it, for late messages and rows
constexpr int64_t kMostJump = 5'000'000;  // [us] a longer gap ends the driving
constexpr double kSure = 2.0;             // standard deviations for reporting a size

int64_t microseconds(double seconds) {
  return std::llround(1e6 * seconds);
}

/// Wording for a changed part.
struct PartWords {
  const char* subject;
  const char* more;  ///< meaning of a positive change
  const char* less;
  const char* unit;
  double factor;       ///< conversion to that unit
  const char* causes;  ///< possible causes
};

PartWords partWords(ChangedPart part) {
  switch (part) {
    case ChangedPart::kLeftDrive:
      return {"the left drive gives", "more", "less", "%", 100.0, "motor, controller or track"};
    case ChangedPart::kRightDrive:
      return {"the right drive gives", "more", "less", "%", 100.0, "motor, controller or track"};
    case ChangedPart::kBothDrives:
      return {"both drives give", "more", "less", "%", 100.0, "ground, load or battery"};
    case ChangedPart::kTurning:
      return {"the vehicle turns", "more", "less", "%", 100.0, "ground, load or tracks"};
    case ChangedPart::kDelay:
      break;
  }
  return {"commands act", "later", "earlier",
          "ms",           1000.0,  "the link, the controller or time stamps"};
}

/// For instance "6 % less than the model says (4 to 8 %)".
std::string sizeOf(const NoticedGap& gap, const PartWords& words) {
  const double size = words.factor * std::abs(gap.change);
  const double error = words.factor * kSure * gap.uncertainty;
  const int places = size < 10.0 ? 1 : 0;
  return digits(size, places) + " " + words.unit + " " +
         (gap.change > 0.0 ? words.more : words.less) + " than the model says (" +
         digits(std::max(0.0, size - error), places) + " to " + digits(size + error, places) + " " +
         words.unit + ")";
}

/// Whether the model depends on the session: empty battery, heat, other ground.
bool dependsOnSession(const VehicleModel& vehicle) {
  constexpr double kLate = 1e6;  // [s] later than any change point
  EntryState fresh, late;
  late.context.session_time = kLate;
  late.context.battery_drop = 0.2;
  late.heat = {1.0, 1.0};
  for (const TrackCommand& command : {TrackCommand{0.5, 0.5}, TrackCommand{0.2, 0.5}}) {
    const std::vector<TrackCommand> commands(20, command);
    const Pose2 one = simulate(vehicle, commands, 0.1, fresh).back();
    const Pose2 other = simulate(vehicle, commands, 0.1, late).back();
    if (one.x != other.x || one.y != other.y || one.yaw != other.yaw) return true;
  }
  return false;
}

}  // namespace

void WallClock::set(int64_t utime, int64_t utc) {
  if (utc > 0) ahead_ = utc - utime;
}

std::string WallClock::timeOf(int64_t utime, int64_t begin) const {
  if (!ahead_) return std::to_string((utime - begin) / 1'000'000) + " s";
  const auto seconds = static_cast<std::time_t>((utime + *ahead_) / 1'000'000);
  std::tm local{};
  localtime_r(&seconds, &local);
  char text[16];
  std::strftime(text, sizeof text, "%H:%M:%S", &local);
  return text;
}

WatchedDrive::WatchedDrive(ModelDocument model, const WatchLimits& limits)
    : model_(std::move(model)), limits_(limits), watch_(limits) {
  if (dependsOnSession(model_.vehicle))
    throw std::runtime_error(model_.vehicle.name +
                             ": watch compares seconds of driving, but this model depends on the "
                             "time before them (time, battery, "
                             "heat); remove such an effect from it");
}

void WatchedDrive::startAt(int64_t utime) {
  recent_.clear();
  if (utime < newest_) watch_.restart();
  newest_ = utime;
  next_ = utime + kBefore;
}

std::optional<WatchLine> WatchedDrive::take(const LogEvent& event) {
  health_t health{};
  if (event.channel == kHealth.name && decode(event, kHealth, health))
    clock_.set(health.utime, health.utc);
  ins_t ins{};
  motor_t motor{};
  const bool of_motor = event.channel == kMotor.name && decode(event, kMotor, motor);
  if (!of_motor && !(event.channel == kIns.name && decode(event, kIns, ins))) return std::nullopt;
  const int64_t utime = of_motor ? motor.utime : ins.utime;
  const bool first = !begin_;
  if (first) begin_ = utime;
  if (first || std::abs(utime - newest_) > kMostJump) startAt(utime);
  newest_ = std::max(newest_, utime);
  if (of_motor &&
      (motor.bridge_state == motor_t::STATE_DRIVING || motor.bridge_state == motor_t::STATE_MANUAL))
    driven_ = utime;
  recent_.push_back(event);
  recent_.back().utime = utime;
  const int64_t length = microseconds(limits_.stretch);
  if (newest_ < next_ + length + kBehind) return std::nullopt;
  auto line = evaluate();
  next_ += length;
  while (!recent_.empty() && recent_.front().utime < next_ - kBefore) recent_.pop_front();
  return line;
}

std::optional<WatchLine> WatchedDrive::evaluate() {
  // A standing robot shows nothing, not even the kind of its commands.
  if (driven_ < next_) return std::nullopt;
  const Drive drive = toDrive(toDriveLog("watch", {recent_.begin(), recent_.end()}));
  if (drive.segments.empty()) return std::nullopt;
  if (drive.kind != model_.vehicle.kind || drive.layout != model_.vehicle.layout())
    throw std::runtime_error(
        "the robot's commands are of another kind than the model's; give the model of this robot");
  int64_t origin = recent_.front().utime;
  for (const LogEvent& event : recent_) origin = std::min(origin, event.utime);
  const double from = 1e-6 * static_cast<double>(next_ - origin);
  auto reading = readChanges(drive, model_, from, from + limits_.stretch);
  if (!reading) return std::nullopt;
  compared_ += limits_.stretch;
  reading->begin = 1e-6 * static_cast<double>(next_);
  reading->end = reading->begin + limits_.stretch;
  const auto gap = watch_.take(*reading);
  if (!gap) return std::nullopt;
  return WatchLine{wordsOf(*gap), watch_.asModel()};
}

std::string WatchedDrive::wordsOf(const NoticedGap& gap) const {
  const PartWords words = partWords(gap.part);
  const std::string since =
      "since " + clock_.timeOf(microseconds(gap.since), begin_.value_or(0)) + " ";
  if (gap.as_model) return since + words.subject + " as the model predicts again";
  return since + words.subject + " " + sizeOf(gap, words) + ": " + words.causes;
}

}  // namespace tread::gap
