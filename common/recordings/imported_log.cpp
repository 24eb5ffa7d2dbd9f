// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/recordings/imported_log.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>

#include "common/execution/stop_reason.hpp"
#include "common/messages/blank.hpp"

namespace tread::recordings {
namespace {

constexpr int64_t kImportOriginUs = 1'000'000;
constexpr int64_t kPeriodUs = 50'000;
constexpr int64_t kSame = 1000;  // [us] of difference between times that are meant to be equal
constexpr int64_t kImportRunId = 1;

int64_t utimeOf(double seconds) {
  return kImportOriginUs + std::llround(seconds * 1e6);
}

/// One execution of the log.
struct Planned {
  execution_record_t record = blank<execution_record_t>();
  int64_t end = 0;  ///< [us]
  bool completed = false;
  std::string reason;
};

/// The first hole that ends after a time and begins before another one.
const CommandHole* holeWithin(const std::vector<CommandHole>& holes, double begin, double end) {
  const auto hole =
      std::upper_bound(holes.begin(), holes.end(), begin,
                       [](double time, const CommandHole& one) { return time < one.end; });
  return hole != holes.end() && hole->begin < end ? &*hole : nullptr;
}

/// The n-th execution of a command; nullopt if the command would be missing at its start.
std::optional<Planned> plannedExecution(const CommandRun& run, int n, const ExecutionLayout& layout,
                                        const std::vector<CommandHole>& holes) {
  const double begin = run.begin + layout.offset + n * layout.length;
  const CommandHole* const hole = holeWithin(holes, begin, begin + layout.length - kPeriod / 2.0);
  const double known = hole == nullptr ? run.end : std::min(run.end, hole->begin);
  Planned planned;
  const int64_t started = planned.record.started = utimeOf(begin);
  if (started >= utimeOf(known)) return std::nullopt;
  const int64_t full = started + utimeOf(layout.length) - kImportOriginUs;
  planned.completed = full <= utimeOf(known) + kPeriodUs / 2;
  planned.end = planned.completed ? full : utimeOf(known);
  if (!planned.completed) planned.reason = known < run.end ? kCommandsMissing : run.end_reason;
  planned.record.record_run_id = kImportRunId;
  planned.record.record_pattern_id = run.step;
  planned.record.record_set_version = 1;
  planned.record.commands_total = static_cast<int32_t>(std::lround(layout.length / kPeriod));
  return planned;
}

std::vector<Planned> plannedExecutions(const std::vector<CommandRun>& runs,
                                       const ExecutionLayout& layout,
                                       const std::vector<CommandHole>& holes) {
  std::vector<Planned> all;
  int64_t number = 0;
  for (const CommandRun& run : runs) {
    ++number;
    for (int n = 0; n < layout.executions; ++n) {
      auto planned = plannedExecution(run, n, layout, holes);
      if (!planned) continue;
      planned->record.record_execution_id = 10 * number + n + 1;
      all.push_back(std::move(*planned));
    }
  }
  return all;
}

class ImportMaker {
 public:
  explicit ImportMaker(ImportCounts& counts) : counts_(counts) {}

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
    const int64_t utime = utimeOf(begin);
    log_.addConfig(utime, "tread-import", utime, text.str());
    log_.addMark(utime, "surface", session.surface);
    std::ostringstream note;
    note << "recording " << session.name << " of a " << session.robot << ", tracks "
         << session.baseline << " m apart; --format " << format << ", poses " << poses << ", gyro "
         << gyro;
    log_.addMark(utime, "note", note.str());
  }

  void addIns(const std::vector<Fix>& fixes, const std::vector<GyroReading>& gyro,
              double longest_step) {
    std::map<int64_t, ins_t> messages;
    int64_t last = 0;
    for (const Fix& fix : fixes) {
      const int64_t utime = utimeOf(fix.time);
      // Two fixes within a microsecond count as one.
      if (utime <= last) continue;
      auto ins = blank<ins_t>();
      fill(ins, fix);
      const bool gap = last > 0 && utime - last > std::llround(longest_step * 1e6);
      if (gap) ins.ins_status |= ins_t::STATUS_GAP;
      // Do not send the same reading twice.
      if (!gyro.empty()) ins.rate[2] = kUnknown;
      messages[last = utime] = ins;
    }
    for (const GyroReading& reading : gyro)
      messages.emplace(utimeOf(reading.time), blank<ins_t>()).first->second.rate[2] =
          reading.yaw_rate;
    for (auto& [utime, ins] : messages) {
      ins.utime = utime;
      log_.add(kIns, ins);
      ++counts_.ins;
    }
  }

  void addGrounds(const std::vector<TimedGround>& grounds) {
    for (const TimedGround& ground : grounds)
      log_.addMark(utimeOf(ground.time), "surface", ground.name);
  }

  void addScans(const std::vector<TimedScan>& scans) {
    for (const TimedScan& scan : scans) {
      scan_t message = scan.message;
      message.utime = utimeOf(scan.time);
      log_.add(kScan, message);
      ++counts_.scans;
    }
  }

  void addMotor(const RecordedDrive& recording, const std::vector<Planned>& executions) {
    size_t at = 0;
    for (const DriveSample& sample : recording.drive) {
      auto motor = blank<motor_t>();
      motor.utime = utimeOf(sample.time);
      fill(motor, recording.channels, sample);
      while (at < executions.size() && executions[at].end <= motor.utime + kPeriodUs / 2) ++at;
      if (at < executions.size()) place(motor, executions[at]);
      log_.add(kMotor, motor);
      ++counts_.motor;
    }
  }

  void addExecutions(const std::vector<Planned>& executions) {
    for (const Planned& planned : executions) {
      execution_record_t& record = log_.start(planned.record);
      log_.publishExecutions(record.started);
      record.ended = planned.end;
      record.outcome = planned.completed ? execution_record_t::OUTCOME_COMPLETED
                                         : execution_record_t::OUTCOME_ABORTED;
      if (!planned.completed) record.outcome_code = static_cast<int16_t>(StopReason::kUnsaid);
      record.outcome_reason = planned.reason;
      record.commands_played =
          static_cast<int32_t>((planned.end - record.started + kPeriodUs - kSame) / kPeriodUs);
      log_.publishExecutions(planned.end);
      ++(planned.completed ? counts_.completed : counts_.aborted);
    }
  }

  std::vector<LogEvent> sorted() {
    std::vector<LogEvent> events = log_.sorted();
    if (!events.empty())
      counts_.duration = static_cast<double>(events.back().utime - events.front().utime) * 1e-6;
    return events;
  }

 private:
  static void fill(ins_t& ins, const Fix& fix) {
    ins.ins_status = ins_t::STATUS_NO_VELOCITY;
    ins.position[0] = fix.T_map_body.x;
    ins.position[1] = fix.T_map_body.y;
    ins.position[2] = fix.z;
    const bool attitude = std::isfinite(fix.roll) && std::isfinite(fix.pitch);
    DriveLogBuilder::setAttitude(ins, fix.T_map_body.yaw, attitude ? fix.pitch : 0.0,
                                 attitude ? fix.roll : 0.0);
    ins.rate[2] = fix.yaw_rate;
    if (!attitude) ins.ins_status |= ins_t::STATUS_NO_ATTITUDE;
    if (fix.new_track) ins.ins_status |= ins_t::STATUS_JUMP;
    if (std::isfinite(fix.unix_time)) ins.device_utc = std::llround(fix.unix_time * 1e6);
  }

  static void fill(motor_t& motor, const CommandChannels& channels, const DriveSample& sample) {
    motor.bridge_state = sample.automatic ? motor_t::STATE_DRIVING : motor_t::STATE_DISARMED;
    const auto reason = sample.automatic ? StopReason::kNone : StopReason::kOperatorDrives;
    motor.state_code = static_cast<int16_t>(reason);
    motor.state_reason = sentenceOf(reason);
    motor.battery_voltage = static_cast<float>(sample.voltage);
    for (size_t c = 0; c < channels.size(); ++c) {
      if (sample.automatic) motor.channel_kind[c] = static_cast<int16_t>(channels[c].kind);
      motor.command[c] = static_cast<float>(sample.command[c]);
      motor.current[c] = static_cast<float>(sample.current[c]);
      motor.measured[c] = static_cast<float>(sample.speed[c]);
    }
  }

  /// Enters the execution that a sample belongs to, if any.
  static void place(motor_t& motor, const Planned& planned) {
    const int64_t since = motor.utime - planned.record.started + kPeriodUs / 2;
    if (since < 0) return;
    motor.motor_run_id = planned.record.record_run_id;
    motor.execution_id = planned.record.record_execution_id;
    motor.command_index = static_cast<int32_t>(since / kPeriodUs);
  }

  ImportCounts& counts_;
  DriveLogBuilder log_;
};

}  // namespace

std::vector<CommandHole> commandHoles(const std::vector<DriveSample>& drive) {
  std::vector<CommandHole> holes;
  for (size_t i = 1; i < drive.size(); ++i)
    if (!drive[i].apart && drive[i].time - drive[i - 1].time > kLongestHold + 1e-6)
      holes.push_back({drive[i - 1].time + kPeriod, drive[i].time});
  return holes;
}

std::vector<LogEvent> makeLog(const RecordedDrive& recording, const Session& session,
                              const std::string& format, const ExecutionLayout& layout,
                              ImportCounts& counts) {
  counts.holes = commandHoles(recording.drive);
  const auto executions = plannedExecutions(recording.runs, layout, counts.holes);
  double begin = std::numeric_limits<double>::max();
  if (!recording.drive.empty()) begin = recording.drive.front().time;
  if (!recording.fixes.empty()) begin = std::min(begin, recording.fixes.front().time);
  if (!recording.scans.empty()) begin = std::min(begin, recording.scans.front().time);
  // In the aligned format poses are interpolated to 20 Hz; elsewhere fixes come at the rate of the
  // ICP.
  const double step = format == "aligned" ? kPeriod : 1.0 / session.pose_rate;
  ImportMaker maker(counts);
  maker.addNotes(session, format, !recording.gyro.empty(), layout, begin);
  maker.addIns(recording.fixes, recording.gyro, 3.0 * step);
  maker.addMotor(recording, executions);
  maker.addScans(recording.scans);
  maker.addGrounds(recording.grounds);
  maker.addExecutions(executions);
  return maker.sorted();
}

}  // namespace tread::recordings
