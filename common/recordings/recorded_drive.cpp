// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors

#include "common/recordings/recorded_drive.hpp"

#include <cmath>
#include <optional>

#include "common/recordings/csv_table.hpp"

namespace tread::recordings {
namespace {

/// A drive is no longer than this, and turns no more often; poses beyond are invalid.
constexpr double kFarthest = 100'000.0;   // [m]
constexpr double kMostTurned = 10'000.0;  // [rad]

double metres(const CsvTable& table, size_t row, std::string_view column) {
  return table.numberWithin(row, column, -kFarthest, kFarthest);
}

double angle(const CsvTable& table, size_t row, std::string_view column) {
  return table.numberWithin(row, column, -kMostTurned, kMostTurned);
}

/// Rows [first, last) of one step and the time [s] of its t_s = 0 in the recording.
struct StepRows {
  size_t first;
  size_t last;
  double origin;
};

/// Groups rows by step and places the groups in sequence with a silence between them.
/** `before` [s]: how much earlier than its row a fix may be. */
std::vector<StepRows> placedSteps(const CsvTable& table, double before) {
  std::vector<StepRows> steps;
  double end = 0.0;
  for (size_t row = 0; row < table.rows();) {
    const int step = table.integer(row, "step");
    size_t last = row;
    while (last < table.rows() && table.integer(last, "step") == step) {
      if (last > row && table.number(last, "t_s") <= table.number(last - 1, "t_s"))
        throw table.error(last, "t_s does not grow within the step; are the rows in order?");
      ++last;
    }
    const double begin = table.number(row, "t_s") - before;
    // Whole periods, so that samples of all steps lie on one grid.
    const double origin = std::ceil((end + kSilence - begin) / kPeriod) * kPeriod;
    end = origin + table.number(last - 1, "t_s");
    steps.push_back({row, last, origin});
    row = last;
  }
  return steps;
}

TrackCommand trackSpeeds(const CsvTable& table, size_t row, double radius, const char* left,
                         const char* right) {
  return {radius * table.number(row, left), radius * table.number(row, right)};
}

/// The first row of [first, last), whose times grow, that is not before a time.
size_t rowFrom(const CsvTable& table, size_t first, size_t last, double time) {
  while (first < last) {
    const size_t middle = first + (last - first) / 2;
    if (table.number(middle, "t_s") < time)
      first = middle + 1;
    else
      last = middle;
  }
  return first;
}

/// The gyro's reading at a fix, for late poses and a timely gyro: the one nearest to a time among
/// the rows [first, last), within one period; else NaN.
double gyroAt(const CsvTable& table, size_t first, size_t last, double time, const char* gyro,
              double sign) {
  double nearest = 1.01 * kPeriod;
  double reading = kUnknown;
  for (size_t row = rowFrom(table, first, last, time - 2.0 * kPeriod); row < last; ++row) {
    const double after = table.number(row, "t_s") - time;
    if (after >= 2.0 * kPeriod) break;
    const double distance = std::abs(after);
    if (distance >= nearest) continue;
    nearest = distance;
    reading = sign * table.number(row, gyro);
  }
  return reading;
}

/// The two formats by step: a sample for each row, and the fixes that `fixOf` extracts from it.
template <class FixOf>
RecordedDrive readByStep(const CsvTable& table, const Session& session, double before,
                         const FixOf& fixOf) {
  RecordedDrive drive;
  for (const StepRows& rows : placedSteps(table, before)) {
    bool new_track = true;
    for (size_t row = rows.first; row < rows.last; ++row) {
      DriveSample sample;
      sample.time = rows.origin + table.number(row, "t_s");
      sample.apart = row == rows.first;
      sample.command =
          trackSpeeds(table, row, session.wheel_radius, "cmd_left_rad_s", "cmd_right_rad_s");
      sample.speed =
          trackSpeeds(table, row, session.wheel_radius, "wheel_left_rad_s", "wheel_right_rad_s");
      drive.drive.push_back(sample);
      std::optional<Fix> fix = fixOf(row, rows);
      if (!fix) continue;
      fix->T_map_body = {metres(table, row, "x_m"), metres(table, row, "y_m"),
                         angle(table, row, "yaw_rad")};
      fix->new_track = new_track;
      new_track = false;
      drive.fixes.push_back(*fix);
    }
    // From t_s = 0, where the step's command began.
    drive.runs.push_back({table.integer(rows.first, "step"), rows.origin,
                          rows.origin + table.number(rows.last - 1, "t_s") + kPeriod,
                          "the recording of the step ends"});
  }
  return drive;
}

DriveSample continuousSample(const CsvTable& table, size_t row, double origin,
                             const Session& session) {
  DriveSample sample;
  sample.time = origin + table.number(row, "t_s");
  sample.automatic = table.text(row, "state") == "calib";
  const double v = table.number(row, "cmd_v_m_s");
  const double half = table.number(row, "cmd_w_rad_s") * session.baseline / 2.0;
  if (sample.automatic) sample.command = {v - half, v + half};
  sample.speed =
      trackSpeeds(table, row, session.wheel_radius, "wheel_left_rad_s", "wheel_right_rad_s");
  // Zero volts: the controllers had not reported yet.
  const double left = table.number(row, "volt_left");
  const double right = table.number(row, "volt_right");
  if (left > 1.0 && right > 1.0) {
    sample.voltage = (left + right) / 2.0;
    sample.current = {table.number(row, "current_left"), table.number(row, "current_right")};
  }
  return sample;
}

Fix continuousFix(const CsvTable& table, size_t row, double origin, const Session& session) {
  Fix fix;
  fix.time = origin + table.number(row, "t_s") - session.pose_lag;
  fix.unix_time = table.number(row, "unix_s") - session.pose_lag;
  fix.T_map_body = {metres(table, row, "map_x_m"), metres(table, row, "map_y_m"),
                    angle(table, row, "map_yaw_rad")};
  fix.z = metres(table, row, "map_z_m");
  fix.roll = angle(table, row, "map_roll_rad");
  fix.pitch = angle(table, row, "map_pitch_rad");
  // Rows that can contain the gyro of that time, with a margin.
  const auto back = static_cast<size_t>((session.pose_lag + 1.0) / kPeriod);
  fix.yaw_rate =
      gyroAt(table, row > back ? row - back : 0, row + 1,
             table.number(row, "t_s") - session.pose_lag, "imu_wz_rad_s", session.imu_sign);
  return fix;
}

/// Begins, continues or ends a run with one more sample.
class RunFinder {
 public:
  explicit RunFinder(std::vector<CommandRun>& runs) : runs_(runs) {}

  void add(int step, const DriveSample& sample) {
    const bool moves = sample.command != Command{};
    const bool continues =
        open_ && sample.automatic && step == runs_.back().step && sample.command == command_;
    if (open_ && !continues)
      runs_.back().end_reason = sample.automatic ? "the next command" : "the operator took over";
    open_ = continues;
    if (!open_ && sample.automatic && moves) {
      runs_.push_back({step, sample.time, sample.time, "the recording ends"});
      command_ = sample.command;
      open_ = true;
    }
    if (open_) runs_.back().end = sample.time + kPeriod;
  }

 private:
  std::vector<CommandRun>& runs_;
  Command command_;
  bool open_ = false;
};

/// All readings of a gyro, one for each row.
void keepGyro(const CsvTable& table, const char* column, double sign, RecordedDrive& drive) {
  for (size_t row = 0; row < table.rows(); ++row)
    drive.gyro.push_back({drive.drive[row].time, sign * table.number(row, column)});
}

}  // namespace

RecordedDrive readSteps(const std::string& path, const Session& session, Gyro kept) {
  const CsvTable table(path);
  constexpr const char* kGyro = "imu_yaw_rate_rad_s";
  RecordedDrive drive =
      readByStep(table, session, session.pose_lag,
                 [&](size_t row, const StepRows& rows) -> std::optional<Fix> {
                   if (table.integer(row, "pose_new") == 0) return std::nullopt;
                   const double time = table.number(row, "t_s") - session.pose_lag;
                   Fix fix;
                   fix.time = rows.origin + time;
                   fix.z = metres(table, row, "z_m");
                   if (session.absolute_attitude) {
                     fix.roll = angle(table, row, "roll_rad");
                     fix.pitch = angle(table, row, "pitch_rad");
                   }
                   fix.yaw_rate = gyroAt(table, rows.first, rows.last, time, kGyro, 1.0);
                   return fix;
                 });
  if (table.rows() != session.rows)
    throw table.error(table.rows() - 1, "the file ends after " + std::to_string(table.rows()) +
                                            " rows, sessions.csv says " +
                                            std::to_string(session.rows) +
                                            "; is the file truncated?");
  if (kept == Gyro::kAll) keepGyro(table, kGyro, 1.0, drive);
  return drive;
}

RecordedDrive readAligned(const std::string& path, const Session& session) {
  const CsvTable table(path);
  return readByStep(table, session, 0.0,
                    [&](size_t row, const StepRows& rows) -> std::optional<Fix> {
                      // Interpolation across a long ICP gap is no measurement.
                      if (table.number(row, "pose_gap_s") > kMaxInterpolated) return std::nullopt;
                      Fix fix;
                      fix.time = rows.origin + table.number(row, "t_s");
                      return fix;
                    });
}

RecordedDrive readContinuous(const std::string& path, const Session& session, Gyro kept) {
  const CsvTable table(path);
  RecordedDrive drive;
  RunFinder finder(drive.runs);
  // The first fix precedes the first row.
  const double origin = kSilence;
  for (size_t row = 0; row < table.rows(); ++row) {
    if (row > 0 && table.number(row, "t_s") <= table.number(row - 1, "t_s"))
      throw table.error(row, "t_s does not grow; are the rows in order?");
    drive.drive.push_back(continuousSample(table, row, origin, session));
    finder.add(table.integer(row, "step"), drive.drive.back());
    if (table.integer(row, "pose_new") == 0) continue;
    drive.fixes.push_back(continuousFix(table, row, origin, session));
    drive.fixes.back().new_track = drive.fixes.size() == 1;
  }
  if (kept == Gyro::kAll) keepGyro(table, "imu_wz_rad_s", session.imu_sign, drive);
  return drive;
}

}  // namespace tread::recordings
