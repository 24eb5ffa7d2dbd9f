// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/import/foreign_log.hpp"

#include <algorithm>
#include <cmath>

#include "common/messages/blank.hpp"
#include "common/recordings/csv_table.hpp"
#include "common/recordings/foreign_types.hpp"
#include "common/report/text.hpp"
#include "common/types/message_type.hpp"

namespace tread::import {
namespace {

using recordings::DriveSample;
using recordings::foreignTypes;
using recordings::RecordedDrive;
using recordings::RecordingError;

/// Closer returns hit the laser's own housing [m].
constexpr double kNearestReturn = 0.1;
constexpr double kLongestScan = 1.0;  // [s]

/// A message with its time.
struct Timed {
  double time = 0.0;  // [s] since the log's first one
  std::string channel;
  std::map<std::string, std::vector<double>> content;  // by field
};

double of(const Timed& message, const char* field) {
  return message.content.at(field).at(0);
}

bool finite(const Timed& message) {
  for (const auto& [name, numbers] : message.content)
    for (const double number : numbers)
      if (!std::isfinite(number)) return false;
  return true;
}

/// Damaged bytes of a log and the time that they span.
class Damage {
 public:
  /// Adds an event that was read from the bytes [from, to).
  void add(uint64_t from, uint64_t to, const LogEvent& event) {
    constexpr uint64_t kHeader = 28;  // [bytes] of an event
    const uint64_t bytes = kHeader + event.channel.size() + event.bytes.size();
    // A sealed event is followed by its seal.
    if (!event.sealed && to - from > bytes) add(from, to - from - bytes, event.utime);
    if (!first_) first_ = event.utime;
    last_ = event.utime;
  }

  /// End of the file: the remaining bytes are damaged.
  void finish(uint64_t from, uint64_t size, ForeignDrive& result) {
    if (size > from) add(from, size - from, last_);
    if (places_ == 0) return;
    const std::string where = "damaged, at " + std::to_string(places_) +
                              (places_ == 1 ? " place" : " places") + ", the first at byte ";
    result.lose(where + std::to_string(at_), bytes_, size, "bytes");
    const double begin = 1e-6 * static_cast<double>(since_ - first_.value_or(since_));
    if (seconds_ > 0.0)
      result.losses.push_back({"in which bytes are damaged, from " + fixed(begin, 1) + " s on",
                               seconds_, 1e-6 * static_cast<double>(last_ - *first_), "s"});
  }

 private:
  void add(uint64_t at, uint64_t bytes, int64_t until) {
    if (places_++ == 0) {
      at_ = at;
      since_ = first_ ? last_ : until;
    }
    bytes_ += bytes;
    if (first_) seconds_ += 1e-6 * static_cast<double>(until - last_);
  }

  std::optional<int64_t> first_;  // [us] of the first undamaged event
  int64_t last_ = 0;              // [us]
  int64_t since_ = 0;             // [us] last event before the first damage
  size_t places_ = 0;
  uint64_t at_ = 0;  // first damaged byte
  uint64_t bytes_ = 0;
  double seconds_ = 0.0;
};

/// Time stamps of a log: of the messages and of the recorder. An LCM log has both in us.
class LogTimes {
 public:
  /// Time of recording of an event [us]. A recorder that counts ns is recognized by its dates and
  /// converted.
  int64_t recorded(const LogEvent& event) {
    ++events_;
    if (!isCalendar(1e-9 * static_cast<double>(event.utime))) return event.utime;
    ++in_ns_;
    return event.utime / 1000;
  }

  void add(const std::string& channel, double own, double recorded) {
    if (!first_) first_ = {own, recorded};
    last_ = {own, recorded};
    own_[channel].push_back(own);
  }

  /// Throws if messages or recorder use another unit.
  void check(const std::string& path, ForeignDrive& result) const {
    if (2 * in_ns_ > events_)
      result.notes.push_back("the recorder's times are ns, not us; read as such");
    if (!first_) return;
    const bool own_is_date = isCalendar(1e-6 * first_->first);
    if (const auto pace = thousands())
      throw RecordingError(path +
                           (own_is_date
                                ? ": its recorder counts time in " + unitOf(-*pace) +
                                      ", its messages in us; make the recorder count us"
                                : ": its messages count time in " + unitOf(*pace) +
                                      ", but their types prescribe us; make the sender count us") +
                           ", or correct the log");
    const auto& [channel, times] = *std::max_element(
        own_.begin(), own_.end(),
        [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); });
    if (const auto problem = timeUnitProblem(times, 1e-6))
      throw RecordingError(path + ": " + channel + ": " + *problem +
                           "; make the sender count us, or correct the log");
  }

 private:
  static std::string unitOf(int thousands) {
    return thousands == 1 ? "ns" : thousands == -1 ? "ms" : "s";
  }

  /// Power of 1000 between the units of message and recorder times; nullopt if they agree.
  std::optional<int> thousands() const {
    constexpr double kLeast = 1e5;  // shortest span for a comparison
    const double own = last_.first - first_->first;
    const double recorded = last_.second - first_->second;
    if (std::max(own, recorded) < kLeast || recorded <= 0.0) return std::nullopt;
    for (const int thousands : {1, -1, -2})
      if (std::abs(own / recorded / std::pow(1e3, thousands) - 1.0) < 0.2) return thousands;
    return std::nullopt;
  }

  size_t events_ = 0;
  size_t in_ns_ = 0;                                // of the events, with times in ns
  std::optional<std::pair<double, double>> first_;  // [us] of a message, and its time of recording
  std::pair<double, double> last_;
  std::map<std::string, std::vector<double>> own_;  // [us] by channel
};

class LogContent {
 public:
  LogContent(const std::string& path, ForeignDrive& result) : path_(path), result_(result) {
    LogReader reader(path);
    LogEvent event;
    Damage damage;
    uint64_t at = 0;
    for (; reader.next(event); at = reader.position()) {
      event.utime = times_.recorded(event);
      damage.add(at, reader.position(), event);
      take(event);
    }
    damage.finish(at, reader.position(), result_);
    times_.check(path, result_);
    for (const auto& [what, count] : broken_)
      result_.lose(what, count, events_, "messages of known types");
    if (by_type_.empty())
      throw RecordingError(path + ": holds no type that tread-import knows; known are " + known());
  }

  std::vector<Timed>& all(const char* type) { return by_type_[type]; }

  /// The poses of one channel, odometry_t or pose_xyt_t.
  std::vector<Timed> poses(const std::string& wanted) {
    std::map<std::string, std::vector<Timed>> channels;
    for (const char* type : {"pose_xyt_t", "odometry_t"})
      for (const Timed& pose : all(type)) channels[pose.channel].push_back(pose);
    if (channels.empty() && wanted.empty()) return {};
    const auto chosen = wanted.empty() ? channels.begin() : channels.find(wanted);
    if (chosen == channels.end() || (wanted.empty() && channels.size() > 1))
      throw RecordingError(path_ + ": poses are on " + namesOf(channels) +
                           "; choose one with --pose-channel");
    for (const auto& [name, messages] : channels)
      if (name != chosen->first) leaveOut(name + ": another --pose-channel", messages.size());
    result_.poses = chosen->first;
    return chosen->second;
  }

  void leaveOut(const std::string& what, size_t count = 1) { result_.left_out[what] += count; }

 private:
  static std::string namesOf(const std::map<std::string, std::vector<Timed>>& channels) {
    std::string names;
    for (const auto& [name, messages] : channels) names += (names.empty() ? "" : ", ") + name;
    return names.empty() ? "no channel" : names;
  }

  static std::string known() {
    std::string names;
    for (const auto& [name, type] : foreignTypes().all())
      names += (names.empty() ? "" : ", ") + name;
    return names;
  }

  void take(const LogEvent& event) {
    const MessageType* const type = foreignTypes().typeOf(event.bytes);
    if (type == nullptr) return leaveOut(event.channel + ": another type");
    auto content = numbersOf(foreignTypes(), *type, event.bytes);
    ++events_;
    if (!content) return void(++broken_[event.channel + ": broken"]);
    // Some senders leave the time empty; then the logger's time is used, shifted to the senders'
    // clock.
    const double utime = content->at("utime").at(0);
    if (utime > 0.0 && !offset_) offset_ = utime - static_cast<double>(event.utime);
    if (utime > 0.0) times_.add(event.channel, utime, static_cast<double>(event.utime));
    const double at =
        utime > 0.0 ? utime : static_cast<double>(event.utime) + offset_.value_or(0.0);
    if (!begin_) begin_ = at;
    const double since = (at - *begin_) * 1e-6;
    Timed message{since, event.channel, std::move(*content)};
    if (!finite(message) || std::abs(since) > kLongest)
      return void(++broken_[event.channel + ": numbers or times out of range"]);
    by_type_[type->name].push_back(std::move(message));
  }

  std::string path_;
  ForeignDrive& result_;
  std::map<std::string, std::vector<Timed>> by_type_;
  size_t events_ = 0;                     // of known types
  std::map<std::string, size_t> broken_;  // damaged events, by reason
  std::optional<double> offset_;          // [us] of the senders' clock from the logger's
  std::optional<double> begin_;           // [us] of the first message
  LogTimes times_;
};

void takePoses(const std::string& path, std::vector<Timed> poses, ForeignDrive& result) {
  sortByTime(
      poses, "poses", [](const Timed& a, const Timed& b) { return a.content == b.content; },
      result);
  std::vector<recordings::Fix>& fixes = result.drive.fixes;
  for (const Timed& pose : poses) {
    const double x = of(pose, "x");
    const double y = of(pose, "y");
    if (std::max(std::abs(x), std::abs(y)) > kFarthest)
      throw RecordingError(path + ": a pose on " + pose.channel + " is at x " + std::to_string(x) +
                           ", y " + std::to_string(y) + " m, beyond 100 km; is the log damaged?");
    recordings::Fix fix;
    fix.time = pose.time;
    fix.T_map_body = {x, y, of(pose, "theta")};
    fix.new_track = fixes.empty();
    fixes.push_back(fix);
  }
  takeJumpsOut(
      fixes, [&](size_t i) { return fixed(poses[i].time, 2) + " s on " + poses[i].channel; },
      result);
}

void takeCommands(std::vector<DriveSample> commands, ForeignDrive& result) {
  sortByTime(
      commands, "commands",
      [](const DriveSample& a, const DriveSample& b) { return a.command == b.command; }, result);
  std::vector<double> times;
  for (const DriveSample& command : commands) times.push_back(command.time);
  const double period = usualPeriod(times);
  holdCommands(commands, period, holdOf(period), result.drive);
  findRuns(result.drive);
}

/// Commands as recorded; the message types in the log determine their kind.
std::vector<DriveSample> commandsOf(const std::string& path, LogContent& log, double baseline,
                                    CommandKind& kind) {
  std::vector<DriveSample> samples;
  const auto add = [&](const Timed& message, const TrackCommand& command) -> DriveSample& {
    DriveSample& sample = samples.emplace_back();
    sample.time = message.time;
    sample.command = command;
    sample.speed = recordings::allUnknown();
    return sample;
  };
  kind = CommandKind::kPower;
  for (const Timed& m : log.all("mbot_wheel_ctrl_t"))
    add(m, {of(m, "left_motor_pwm_cmd"), of(m, "right_motor_pwm_cmd")}).speed = {
        of(m, "left_motor_vel"), of(m, "right_motor_vel")};
  if (!samples.empty()) return samples;
  for (const Timed& m : log.all("mbot_motor_pwm_t"))
    add(m, {of(m, "left_motor_pwm"), of(m, "right_motor_pwm")});
  for (const Timed& m : log.all("maebot_motor_command_t"))
    add(m, {of(m, "left_motor_speed") * of(m, "left_motor_enabled"),
            of(m, "right_motor_speed") * of(m, "right_motor_enabled")});
  if (!samples.empty()) return samples;
  const std::vector<Timed>& bodies = log.all("mbot_motor_command_t");
  if (!bodies.empty() && baseline <= 0.0)
    throw RecordingError(path +
                         ": commands are body speeds; give --baseline, the metres between "
                         "the wheels");
  kind = CommandKind::kTrackSpeed;
  for (const Timed& m : bodies)
    add(m, recordings::trackCommand({of(m, "trans_v"), of(m, "angular_v")}, baseline));
  return samples;
}

/// One revolution of the laser as points. Senders stamp the beams in us or in ms.
std::optional<recordings::TimedScan> scanOf(const Timed& laser, double height) {
  auto scan = blank<scan_t>();
  scan.sensor_position[0] = scan.sensor_position[1] = 0.0;
  scan.sensor_position[2] = height;
  scan.sensor_orientation[0] = 1.0;
  for (int i = 1; i < 4; ++i) scan.sensor_orientation[i] = 0.0;
  const std::vector<double>& ranges = laser.content.at("ranges");
  const std::vector<double>& angles = laser.content.at("thetas");
  const std::vector<double>& times = laser.content.at("times");
  for (size_t i = 0; i < ranges.size(); ++i)
    if (ranges[i] > kNearestReturn)
      scan.points.push_back({static_cast<float>(ranges[i] * std::cos(angles[i])),
                             static_cast<float>(-ranges[i] * std::sin(angles[i])), 0.0F});
  if (scan.points.empty()) return std::nullopt;
  scan.num_points = static_cast<int32_t>(scan.points.size());
  // No revolution takes less than 2 ms, so shorter ones are in ms.
  double turn = times.back() - times.front();
  if (turn < 2000.0) turn *= 1000.0;
  scan.duration = static_cast<int32_t>(std::clamp(turn, 0.0, kLongestScan * 1e6));
  return recordings::TimedScan{laser.time, scan};
}

}  // namespace

ForeignDrive readForeignLog(const std::string& path, const ForeignRobot& robot) {
  ForeignDrive result;
  LogContent log(path, result);
  RecordedDrive& drive = result.drive;
  takePoses(path, log.poses(robot.pose_channel), result);
  CommandKind kind = CommandKind::kPower;
  takeCommands(commandsOf(path, log, robot.baseline, kind), result);
  drive.channels = trackChannels(kind);
  for (const Timed& laser : log.all("lidar_t")) {
    if (auto scan = scanOf(laser, robot.lidar_height))
      drive.scans.push_back(std::move(*scan));
    else
      log.leaveOut(laser.channel + ": without returns");
  }
  if (drive.fixes.empty() && drive.drive.empty() && drive.scans.empty())
    throw RecordingError(path + ": holds neither poses nor commands nor scans");
  return result;
}

}  // namespace tread::import
