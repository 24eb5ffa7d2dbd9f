// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/recordings/drive_log.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include <Eigen/Geometry>

#include "common/messages/blank.hpp"

namespace tread::importer {
namespace {

constexpr int64_t kOriginUs = 1'000'000;
constexpr int64_t kPeriodUs = 50'000;
constexpr int64_t kRunId = 1;
constexpr size_t kRepeated = 8;

/// To whole milliseconds: the recordings know no more.
int64_t utimeOf(double seconds) {
  return kOriginUs + std::llround(seconds * 1e3) * 1000;
}

/// One execution of the log.
struct Planned {
  execution_record_t record = blank<execution_record_t>();
  int64_t end = 0;  ///< [us]
  bool completed = false;
  std::string reason;
};

std::vector<Planned> plannedExecutions(const std::vector<CommandRun>& runs,
                                       const ExecutionLayout& layout) {
  std::vector<Planned> all;
  int64_t number = 0;
  for (const CommandRun& run : runs) {
    ++number;
    for (int n = 0; n < layout.executions; ++n) {
      const int64_t started = utimeOf(run.begin + layout.offset + n * layout.length);
      const int64_t full = started + utimeOf(layout.length) - kOriginUs;
      const int64_t run_end = utimeOf(run.end);
      if (started >= run_end) break;
      Planned planned;
      planned.completed = full <= run_end + kPeriodUs / 2;
      planned.end = planned.completed ? full : run_end;
      planned.reason = planned.completed ? "" : run.end_reason;
      planned.record.record_run_id = kRunId;
      planned.record.record_execution_id = 10 * number + n + 1;
      planned.record.record_pattern_id = run.step;
      planned.record.record_set_version = 1;
      planned.record.started = started;
      planned.record.commands_total = static_cast<int32_t>(std::lround(layout.length / kPeriod));
      all.push_back(planned);
    }
  }
  return all;
}

class LogMaker {
 public:
  explicit LogMaker(LogCounts& counts) : counts_(counts) {}

  void addNotes(const Session& session, const std::string& format, bool all_gyro,
                const ExecutionLayout& layout, double begin) {
    const std::string poses = session.lag_kept ? "as logged" : "as measured";
    const std::string gyro = all_gyro ? "all" : "at fixes";
    std::ostringstream text;
    text << "recording: " << session.name << "\nrobot: \"" << session.robot
         << "\"\nformat: " << format << "\nwheel_radius: " << session.wheel_radius
         << "\nbaseline: " << session.baseline << "\npose_lag_removed: " << session.pose_lag
         << "\nposes: " << poses << "\ngyro: " << gyro << "\noffset: " << layout.offset
         << "\nlength: " << layout.length << "\nexecutions: " << layout.executions << "\n";
    auto config = blank<config_t>();
    config.utime = utimeOf(begin);
    config.config_process = "tread-import";
    config.config_boot_id = config.utime;
    config.config_text = text.str();
    add(kConfig, config);
    addMark(config.utime, 0, "surface", session.surface);
    std::ostringstream note;
    note << "recording " << session.name << " of a " << session.robot << ", tracks "
         << session.baseline << " m apart; --format " << format << ", poses " << poses << ", gyro "
         << gyro;
    addMark(config.utime, 1, "note", note.str());
  }

  void addIns(const std::vector<Fix>& fixes, const std::vector<GyroReading>& gyro,
              double longest_step) {
    std::map<int64_t, ins_t> messages;
    int64_t last = 0;
    for (const Fix& fix : fixes) {
      const int64_t utime = utimeOf(fix.time);
      // Two fixes within a millisecond are one.
      if (utime <= last) continue;
      auto ins = blank<ins_t>();
      fill(ins, fix);
      const bool gap = last > 0 && utime - last > std::llround(longest_step * 1e6);
      if (gap) ins.ins_status |= ins_t::STATUS_GAP;
      // The same reading must not be said twice.
      if (!gyro.empty()) ins.rate[2] = kUnknown;
      messages[last = utime] = ins;
    }
    for (const GyroReading& reading : gyro)
      messages.emplace(utimeOf(reading.time), blank<ins_t>()).first->second.rate[2] =
          reading.yaw_rate;
    int64_t seq = 0;
    for (auto& [utime, ins] : messages) {
      ins.utime = utime;
      ins.seq = seq++;
      add(kIns, ins);
      ++counts_.ins;
    }
  }

  void addMotor(const std::vector<DriveSample>& drive, const std::vector<Planned>& executions) {
    int64_t seq = 0;
    size_t at = 0;
    for (const DriveSample& sample : drive) {
      auto motor = blank<motor_t>();
      motor.utime = utimeOf(sample.time);
      motor.seq = seq++;
      fill(motor, sample);
      while (at < executions.size() && executions[at].end <= motor.utime + kPeriodUs / 2) ++at;
      if (at < executions.size()) place(motor, executions[at]);
      add(kMotor, motor);
      ++counts_.motor;
    }
  }

  void addExecutions(const std::vector<Planned>& executions) {
    for (const Planned& planned : executions) {
      records_.push_back(planned.record);
      if (records_.size() > kRepeated) records_.erase(records_.begin());
      say(planned.record.started);
      execution_record_t& record = records_.back();
      record.ended = planned.end;
      record.outcome = planned.completed ? execution_record_t::OUTCOME_COMPLETED
                                         : execution_record_t::OUTCOME_ABORTED;
      record.outcome_reason = planned.reason;
      record.commands_played =
          static_cast<int32_t>((planned.end - record.started + kPeriodUs - 1) / kPeriodUs);
      say(planned.end);
      ++(planned.completed ? counts_.completed : counts_.aborted);
    }
  }

  std::vector<LogEvent> sorted() {
    std::stable_sort(events_.begin(), events_.end(),
                     [](const LogEvent& a, const LogEvent& b) { return a.utime < b.utime; });
    if (!events_.empty())
      counts_.duration = static_cast<double>(events_.back().utime - events_.front().utime) * 1e-6;
    return std::move(events_);
  }

 private:
  template <class Message>
  void add(const Channel<Message>& channel, const Message& message) {
    events_.push_back(eventOf(channel, message));
  }

  void addMark(int64_t utime, int64_t seq, const std::string& kind, const std::string& value) {
    auto mark = blank<mark_t>();
    mark.utime = utime;
    mark.seq = seq;
    mark.mark_kind = kind;
    mark.mark_value = value;
    add(kMark, mark);
  }

  void say(int64_t utime) {
    auto message = blank<execution_t>();
    message.utime = utime;
    message.seq = seq_execution_++;
    message.records = records_;
    message.num_records = static_cast<int32_t>(records_.size());
    add(kExecution, message);
  }

  static void fill(ins_t& ins, const Fix& fix) {
    ins.ins_status = ins_t::STATUS_NO_VELOCITY;
    ins.position[0] = fix.T_map_body.x;
    ins.position[1] = fix.T_map_body.y;
    ins.position[2] = fix.z;
    const bool attitude = std::isfinite(fix.roll) && std::isfinite(fix.pitch);
    using Eigen::AngleAxisd;
    using Eigen::Vector3d;
    Eigen::Quaterniond q(AngleAxisd(fix.T_map_body.yaw, Vector3d::UnitZ()));
    if (attitude)
      q = q * AngleAxisd(fix.pitch, Vector3d::UnitY()) * AngleAxisd(fix.roll, Vector3d::UnitX());
    ins.orientation[0] = q.w();
    ins.orientation[1] = q.x();
    ins.orientation[2] = q.y();
    ins.orientation[3] = q.z();
    ins.rate[2] = fix.yaw_rate;
    if (!attitude) ins.ins_status |= ins_t::STATUS_NO_ATTITUDE;
    if (fix.new_track) ins.ins_status |= ins_t::STATUS_JUMP;
    if (std::isfinite(fix.unix_time)) ins.device_utc = std::llround(fix.unix_time * 1e6);
  }

  static void fill(motor_t& motor, const DriveSample& sample) {
    motor.bridge_state = sample.automatic ? motor_t::STATE_DRIVING : motor_t::STATE_DISARMED;
    motor.state_reason = sample.automatic ? "" : "idle or driven by the operator";
    if (sample.automatic) motor.motor_command_kind = static_cast<int16_t>(CommandKind::kTrackSpeed);
    motor.command_left = static_cast<float>(sample.command.left);
    motor.command_right = static_cast<float>(sample.command.right);
    motor.battery_voltage = static_cast<float>(sample.voltage);
    motor.current_left = static_cast<float>(sample.current.left);
    motor.current_right = static_cast<float>(sample.current.right);
    motor.track_speed_left = static_cast<float>(sample.speed.left);
    motor.track_speed_right = static_cast<float>(sample.speed.right);
  }

  /// Names the execution that a sample belongs to, if it does.
  static void place(motor_t& motor, const Planned& planned) {
    const int64_t since = motor.utime - planned.record.started + kPeriodUs / 2;
    if (since < 0) return;
    motor.motor_run_id = planned.record.record_run_id;
    motor.execution_id = planned.record.record_execution_id;
    motor.command_index = static_cast<int32_t>(since / kPeriodUs);
  }

  LogCounts& counts_;
  std::vector<LogEvent> events_;
  std::vector<execution_record_t> records_;
  int64_t seq_execution_ = 0;
};

}  // namespace

std::vector<LogEvent> makeLog(const Recording& recording, const Session& session,
                              const std::string& format, const ExecutionLayout& layout,
                              LogCounts& counts) {
  const auto executions = plannedExecutions(recording.runs, layout);
  double begin = recording.drive.front().time;
  if (!recording.fixes.empty()) begin = std::min(begin, recording.fixes.front().time);
  // Steps are interpolated to 20 Hz in the aligned format; elsewhere fixes come at the rate of the
  // ICP.
  const double step = format == "aligned" ? kPeriod : 1.0 / session.pose_rate;
  LogMaker maker(counts);
  maker.addNotes(session, format, !recording.gyro.empty(), layout, begin);
  maker.addIns(recording.fixes, recording.gyro, 3.0 * step);
  maker.addMotor(recording.drive, executions);
  maker.addExecutions(executions);
  return maker.sorted();
}

}  // namespace tread::importer
