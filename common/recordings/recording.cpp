// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/recordings/recording.hpp"

#include <algorithm>
#include <cmath>

#include "common/recordings/csv_table.hpp"

namespace tread::importer {
namespace {

/// Longest gap that is interpolated as if the INS had been there [s].
constexpr double kMaxInterpolated = 0.3;

/// Columns that the two formats by step have in common.
struct StepColumns {
  explicit StepColumns(const CsvTable& table)
      : step(table.column("step")),
        time(table.column("t_s")),
        command_left(table.column("cmd_left_rad_s")),
        command_right(table.column("cmd_right_rad_s")),
        wheel_left(table.column("wheel_left_rad_s")),
        wheel_right(table.column("wheel_right_rad_s")),
        x(table.column("x_m")),
        y(table.column("y_m")),
        yaw(table.column("yaw_rad")) {}
  size_t step, time, command_left, command_right, wheel_left, wheel_right, x, y, yaw;
};

/// Rows [first, last) of one step and the time [s] of its t_s = 0 in the recording.
struct StepRows {
  size_t first;
  size_t last;
  double origin;
};

/// Groups of rows by step, placed one after the other with a silence between them.
/** `before` [s]: how much earlier than its row a fix can be. */
std::vector<StepRows> placedSteps(const CsvTable& table, const StepColumns& columns,
                                  double before) {
  std::vector<StepRows> steps;
  double end = 0.0;
  for (size_t row = 0; row < table.rows();) {
    const int step = table.integer(row, columns.step);
    size_t last = row;
    while (last < table.rows() && table.integer(last, columns.step) == step) {
      if (last > row && table.number(last, columns.time) <= table.number(last - 1, columns.time))
        throw table.error(last, "t_s does not grow within the step; are the rows in order?");
      ++last;
    }
    const double begin = table.number(row, columns.time) - before;
    // Whole periods, so that samples of all steps lie on one grid.
    const double origin = std::ceil((end + kSilence - begin) / kPeriod) * kPeriod;
    end = origin + table.number(last - 1, columns.time);
    steps.push_back({row, last, origin});
    row = last;
  }
  return steps;
}

DriveSample driveSample(const CsvTable& table, const StepColumns& columns, size_t row,
                        double origin, const Session& session) {
  const double r = session.wheel_radius;
  DriveSample sample;
  sample.time = origin + table.number(row, columns.time);
  sample.command = {r * table.number(row, columns.command_left),
                    r * table.number(row, columns.command_right)};
  sample.speed = {r * table.number(row, columns.wheel_left),
                  r * table.number(row, columns.wheel_right)};
  return sample;
}

/// The run of a step: from t_s = 0 on, where its command began.
CommandRun runOf(const CsvTable& table, const StepColumns& columns, const StepRows& rows) {
  return {table.integer(rows.first, columns.step), rows.origin,
          rows.origin + table.number(rows.last - 1, columns.time) + kPeriod,
          "the recording of the step ends"};
}

Pose2 poseOf(const CsvTable& table, const StepColumns& columns, size_t row) {
  return {table.number(row, columns.x), table.number(row, columns.y),
          table.number(row, columns.yaw)};
}

/// A gyro that is on time, for poses that are late: the reading nearest to a time, within one
/// period; else NaN.
double gyroAt(const CsvTable& table, size_t first, size_t last, size_t time_column, double time,
              size_t gyro_column, double sign) {
  double nearest = 1.01 * kPeriod;
  double reading = kUnknown;
  for (size_t row = first; row < last; ++row) {
    const double distance = std::abs(table.number(row, time_column) - time);
    if (distance >= nearest) continue;
    nearest = distance;
    reading = sign * table.number(row, gyro_column);
  }
  return reading;
}

}  // namespace

Recording readSteps(const std::string& path, const Session& session, Gyro kept) {
  const CsvTable table(path);
  const StepColumns columns(table);
  const size_t z = table.column("z_m");
  const size_t roll = table.column("roll_rad");
  const size_t pitch = table.column("pitch_rad");
  const size_t fresh = table.column("pose_new");
  const size_t gyro = table.column("imu_yaw_rate_rad_s");
  if (table.rows() != session.rows)
    throw table.error(table.rows() - 1, "the file ends after " + std::to_string(table.rows()) +
                                            " rows, sessions.csv says " +
                                            std::to_string(session.rows) +
                                            "; is the file truncated?");
  Recording recording;
  for (const StepRows& rows : placedSteps(table, columns, session.pose_lag)) {
    bool new_track = true;
    for (size_t row = rows.first; row < rows.last; ++row) {
      recording.drive.push_back(driveSample(table, columns, row, rows.origin, session));
      if (kept == Gyro::kAll)
        recording.gyro.push_back({recording.drive.back().time, table.number(row, gyro)});
      if (table.integer(row, fresh) == 0) continue;
      const double time = table.number(row, columns.time) - session.pose_lag;
      Fix fix;
      fix.time = rows.origin + time;
      fix.T_map_body = poseOf(table, columns, row);
      fix.z = table.number(row, z);
      if (session.absolute_attitude) {
        fix.roll = table.number(row, roll);
        fix.pitch = table.number(row, pitch);
      }
      fix.yaw_rate = gyroAt(table, rows.first, rows.last, columns.time, time, gyro, 1.0);
      fix.new_track = new_track;
      new_track = false;
      recording.fixes.push_back(fix);
    }
    recording.runs.push_back(runOf(table, columns, rows));
  }
  return recording;
}

Recording readAligned(const std::string& path, const Session& session) {
  const CsvTable table(path);
  const StepColumns columns(table);
  const size_t gap = table.column("pose_gap_s");
  Recording recording;
  for (const StepRows& rows : placedSteps(table, columns, 0.0)) {
    bool new_track = true;
    for (size_t row = rows.first; row < rows.last; ++row) {
      recording.drive.push_back(driveSample(table, columns, row, rows.origin, session));
      // What was interpolated across a long ICP gap is not a measurement.
      if (table.number(row, gap) > kMaxInterpolated) continue;
      Fix fix;
      fix.time = rows.origin + table.number(row, columns.time);
      fix.T_map_body = poseOf(table, columns, row);
      fix.new_track = new_track;
      new_track = false;
      recording.fixes.push_back(fix);
    }
    recording.runs.push_back(runOf(table, columns, rows));
  }
  return recording;
}

namespace {

struct ContinuousColumns {
  explicit ContinuousColumns(const CsvTable& table)
      : time(table.column("t_s")),
        unix_time(table.column("unix_s")),
        state(table.column("state")),
        step(table.column("step")),
        v(table.column("cmd_v_m_s")),
        w(table.column("cmd_w_rad_s")),
        wheel_left(table.column("wheel_left_rad_s")),
        wheel_right(table.column("wheel_right_rad_s")),
        x(table.column("map_x_m")),
        y(table.column("map_y_m")),
        z(table.column("map_z_m")),
        roll(table.column("map_roll_rad")),
        pitch(table.column("map_pitch_rad")),
        yaw(table.column("map_yaw_rad")),
        fresh(table.column("pose_new")),
        gyro(table.column("imu_wz_rad_s")),
        volt_left(table.column("volt_left")),
        volt_right(table.column("volt_right")),
        current_left(table.column("current_left")),
        current_right(table.column("current_right")) {}
  size_t time, unix_time, state, step, v, w, wheel_left, wheel_right, x, y, z, roll, pitch, yaw,
      fresh, gyro, volt_left, volt_right, current_left, current_right;
};

DriveSample continuousSample(const CsvTable& table, const ContinuousColumns& columns, size_t row,
                             double origin, const Session& session) {
  DriveSample sample;
  sample.time = origin + table.number(row, columns.time);
  sample.automatic = table.text(row, columns.state) == "calib";
  const double v = table.number(row, columns.v);
  const double half = table.number(row, columns.w) * session.baseline / 2.0;
  if (sample.automatic) sample.command = {v - half, v + half};
  sample.speed = {session.wheel_radius * table.number(row, columns.wheel_left),
                  session.wheel_radius * table.number(row, columns.wheel_right)};
  // Zero volts: the controllers had not reported yet.
  const double left = table.number(row, columns.volt_left);
  const double right = table.number(row, columns.volt_right);
  if (left > 1.0 && right > 1.0) {
    sample.voltage = (left + right) / 2.0;
    sample.current = {table.number(row, columns.current_left),
                      table.number(row, columns.current_right)};
  }
  return sample;
}

Fix continuousFix(const CsvTable& table, const ContinuousColumns& columns, size_t row,
                  double origin, const Session& session) {
  Fix fix;
  fix.time = origin + table.number(row, columns.time) - session.pose_lag;
  fix.unix_time = table.number(row, columns.unix_time) - session.pose_lag;
  fix.T_map_body = {table.number(row, columns.x), table.number(row, columns.y),
                    table.number(row, columns.yaw)};
  fix.z = table.number(row, columns.z);
  fix.roll = table.number(row, columns.roll);
  fix.pitch = table.number(row, columns.pitch);
  // Rows that can hold the gyro of that time, generously.
  const auto back = static_cast<size_t>((session.pose_lag + 1.0) / kPeriod);
  fix.yaw_rate =
      gyroAt(table, row > back ? row - back : 0, row + 1, columns.time,
             table.number(row, columns.time) - session.pose_lag, columns.gyro, session.imu_sign);
  return fix;
}

/// Begins, continues or ends a run with one more sample.
class RunFinder {
 public:
  explicit RunFinder(std::vector<CommandRun>& runs) : runs_(runs) {}

  void add(int step, const DriveSample& sample) {
    const bool moves = sample.command.left != 0.0 || sample.command.right != 0.0;
    const bool goes_on = open_ && sample.automatic && step == runs_.back().step &&
                         sample.command.left == command_.left &&
                         sample.command.right == command_.right;
    if (open_ && !goes_on)
      runs_.back().end_reason = sample.automatic ? "the next command" : "the operator took over";
    open_ = goes_on;
    if (!open_ && sample.automatic && moves) {
      runs_.push_back({step, sample.time, sample.time, "the recording ends"});
      command_ = sample.command;
      open_ = true;
    }
    if (open_) runs_.back().end = sample.time + kPeriod;
  }

 private:
  std::vector<CommandRun>& runs_;
  TrackCommand command_;
  bool open_ = false;
};

}  // namespace

Recording readContinuous(const std::string& path, const Session& session, Gyro kept) {
  const CsvTable table(path);
  const ContinuousColumns columns(table);
  Recording recording;
  RunFinder finder(recording.runs);
  // The first fix is measured before the first row.
  const double origin = kSilence;
  for (size_t row = 0; row < table.rows(); ++row) {
    if (row > 0 && table.number(row, columns.time) <= table.number(row - 1, columns.time))
      throw table.error(row, "t_s does not grow; are the rows in order?");
    const DriveSample sample = continuousSample(table, columns, row, origin, session);
    finder.add(table.integer(row, columns.step), sample);
    recording.drive.push_back(sample);
    if (kept == Gyro::kAll)
      recording.gyro.push_back({sample.time, session.imu_sign * table.number(row, columns.gyro)});
    if (table.integer(row, columns.fresh) == 0) continue;
    recording.fixes.push_back(continuousFix(table, columns, row, origin, session));
    recording.fixes.back().new_track = recording.fixes.size() == 1;
  }
  return recording;
}

}  // namespace tread::importer
