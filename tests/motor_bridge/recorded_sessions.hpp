// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "common/geometry/se2.hpp"
#include "common/pattern/pattern.hpp"
#include "common/recordings/csv_table.hpp"
#include "modules/motor_bridge/core/motion_monitor.hpp"

namespace tread::motor {

/// A continuous drive: commands (track speeds) and measurements over time.
struct RecordedRun {
  struct Sample {
    int64_t utime = 0;
    TrackCommand command;  ///< [m/s] from this time on
    TrackCommand wheels;   ///< [m/s] measured
    InsMotion ins;         ///< without a pose if there is none
  };
  /// A pose of the lidar.
  struct Fix {
    double time = 0.0;  ///< [s]
    Pose2 T_map_body;   ///< yaw unwrapped
    double gap = 0.0;   ///< [s] without a pose before
  };
  std::string session;
  int step = 0;       ///< -1 = a complete log
  bool sound = true;  ///< the lidar's poses were sound
  std::vector<Sample> samples;
  std::vector<Fix> fixes;

  /// [h] with a pose
  double hours() const {
    const auto measured = [](const Sample& sample) { return std::isfinite(sample.ins.x); };
    return 0.05 / 3600.0 *
           static_cast<double>(std::count_if(samples.begin(), samples.end(), measured));
  }
};

/// Poses of an INS, synthesized from the lidar's, which have a varying delay, come 4 to 10 times
/// per second and catch up in jumps.
/** Heading: the integrated gyro, corrected by the smoothed difference from the lidar's yaw (3 s);
 * position: local lines through the lidar's positions (0.35 s). Gyro and heading are then no
 * longer independent. During gaps of the lidar above kMaxGap there is no pose, as its README
 * requires. */
class Fusion {
 public:
  static constexpr double kMaxGap = 0.4;  ///< [s]

  static void fuse(RecordedRun& run) {
    double turned = 0.0;
    double last = seconds(run.samples.front().utime);
    std::vector<double> heading;
    for (RecordedRun::Sample& sample : run.samples) {
      const double rate = sample.ins.yaw_rate;
      const double now = seconds(sample.ins.utime);
      turned += std::isfinite(rate) ? rate * (now - last) : 0.0;
      last = now;
      heading.push_back(turned);
    }
    size_t begin = 0, after = 0;
    for (size_t i = 0; i < run.samples.size(); ++i) {
      InsMotion& ins = run.samples[i].ins;
      const double now = seconds(ins.utime);
      if (now < run.fixes.front().time || now > run.fixes.back().time) continue;
      while (after + 1 < run.fixes.size() && run.fixes[after].time < now) ++after;
      if (run.fixes[after].gap > kMaxGap) continue;
      while (run.fixes[begin].time < now - 3.0) ++begin;
      const auto at = [&](auto value, double width) { return line(run, begin, now, width, value); };
      ins.x = at([](const Pose2& pose, double) { return pose.x; }, 0.35);
      ins.y = at([](const Pose2& pose, double) { return pose.y; }, 0.35);
      ins.yaw =
          heading[i] + at([&](const Pose2& pose,
                              double time) { return pose.yaw - headingAt(run, heading, time); },
                          3.0);
    }
  }

 private:
  static double seconds(int64_t utime) { return 1e-6 * static_cast<double>(utime); }
  static double headingAt(const RecordedRun& run, const std::vector<double>& heading, double time) {
    const auto after = std::partition_point(
        run.samples.begin(), run.samples.end(),
        [time](const RecordedRun::Sample& sample) { return seconds(sample.ins.utime) < time; });
    const auto i = static_cast<size_t>(after - run.samples.begin());
    return heading[std::min(i, heading.size() - 1)];
  }
  /// Value at `now` of a line fitted to neighbours, weighted by a bell of that width [s].
  template <class Value>
  static double line(const RecordedRun& run, size_t begin, double now, double width, Value value) {
    double w = 0.0, wt = 0.0, wtt = 0.0, wv = 0.0, wtv = 0.0;
    for (size_t i = begin; i < run.fixes.size() && run.fixes[i].time < now + 3.0; ++i) {
      const double t = run.fixes[i].time - now;
      const double weight = std::exp(-0.5 * t * t / (width * width)) + 1e-9;
      const double v = value(run.fixes[i].T_map_body, run.fixes[i].time);
      w += weight;
      wt += weight * t;
      wtt += weight * t * t;
      wv += weight * v;
      wtv += weight * t * v;
    }
    const double spread = w * wtt - wt * wt;
    return spread > 1e-6 * w * w ? (wtt * wv - wt * wtv) / spread : wv / w;
  }
};

/// A recorded robot and its limits.
struct RecordedSession {
  std::string name;
  MotionLimits limits;
  double radius = 0.0;    ///< [m] of the wheels
  double pose_lag = 0.0;  ///< [s]
  std::vector<RecordedRun> runs;
};

/// Reads the folder of recorded drives: complete logs if available, else steps.
class SessionReader {
 public:
  explicit SessionReader(std::string folder) : folder_(std::move(folder)) {}

  std::vector<RecordedSession> read() const {
    const recordings::CsvTable table(folder_ + "/sessions.csv");
    const recordings::CsvTable quality(folder_ + "/steps_quality.csv");
    std::vector<RecordedSession> sessions;
    for (size_t row = 0; row < table.rows(); ++row) {
      RecordedSession session = describe(table, row);
      const std::string whole = folder_ + "/continuous/" + session.name + ".csv";
      if (std::filesystem::exists(whole)) {
        readWhole(whole, session);
      } else {
        readSteps(quality, session);
      }
      sessions.push_back(std::move(session));
    }
    return sessions;
  }

 private:
  static constexpr double kStart = 100.0;       ///< [s] utime of the first sample
  static constexpr double kStepInterval = 8.0;  ///< [s] 6 really: 2 s of speeds before each

  static RecordedSession describe(const recordings::CsvTable& table, size_t row) {
    RecordedSession session;
    session.name = table.text(row, "session");
    session.radius = table.number(row, "wheel_radius_m");
    session.pose_lag = table.number(row, "pose_lag_s");
    session.limits.gauge = table.number(row, "baseline_m");
    session.limits.full_speed = session.name.rfind("husky", 0) == 0 ? 1.0 : 5.0;
    session.limits.speed_per_command = 1.0;
    session.limits.dead_band = 0.1;
    session.limits.delay = 0.45;  // including those of encoders and poses
    session.limits.acceleration = 3.0;
    session.limits.time_error = 0.1;  // remaining error of the lidar's
    return session;
  }
  static int64_t us(double seconds) { return std::llround((kStart + seconds) * 1e6); }

  /// The robot's own log: commands of the drive, wheel speeds during manual driving.
  static void readWhole(const std::string& path, RecordedSession& session) {
    const recordings::CsvTable table(path);
    RecordedRun run;
    run.session = session.name;
    run.step = -1;
    for (size_t row = 0; row < table.rows(); ++row) {
      RecordedRun::Sample sample;
      const double t = table.number(row, "t_s");
      sample.utime = us(t);
      // Wheel speeds are an effect: the command came earlier.
      const size_t ahead = std::min(row + 6, table.rows() - 1);
      const double v = table.number(row, "cmd_v_m_s"), w = table.number(row, "cmd_w_rad_s");
      sample.wheels = tracks(table, row, "wheel", session.radius);
      if (table.text(row, "state") == "calib") {
        sample.command = {v - 0.5 * w * session.limits.gauge, v + 0.5 * w * session.limits.gauge};
      } else {
        sample.command = {session.radius * table.number(ahead, "wheel_left_rad_s"),
                          session.radius * table.number(ahead, "wheel_right_rad_s")};
      }
      sample.ins.utime = sample.utime;
      sample.ins.yaw_rate = table.number(row, "imu_wz_rad_s");
      run.samples.push_back(sample);
      if (table.integer(row, "pose_new") == 0) continue;
      Pose2 pose{table.number(row, "map_x_m"), table.number(row, "map_y_m"),
                 table.number(row, "map_yaw_rad")};
      if (!run.fixes.empty()) {
        const double before = run.fixes.back().T_map_body.yaw;
        pose.yaw = before + wrapAngle(pose.yaw - before);
      }
      const double time = kStart + t - session.pose_lag;
      run.fixes.push_back({time, pose, run.fixes.empty() ? 0.0 : time - run.fixes.back().time});
    }
    Fusion::fuse(run);
    session.runs.push_back(std::move(run));
  }

  void readSteps(const recordings::CsvTable& quality, RecordedSession& session) const {
    std::map<int, bool> sound;
    for (size_t row = 0; row < quality.rows(); ++row)
      if (quality.text(row, "session") == session.name)
        sound[quality.integer(row, "step")] = quality.integer(row, "ok") != 0;
    const auto rates = readRates(session);
    const recordings::CsvTable table(folder_ + "/aligned/" + session.name + ".csv");
    RecordedRun run;
    for (size_t row = 0; row < table.rows(); ++row) {
      const int step = table.integer(row, "step");
      const double t = table.number(row, "t_s");
      const double time = kStepInterval * step + t;
      if (run.samples.empty() || step != run.step) {
        if (!run.samples.empty()) finish(run, session);
        run = RecordedRun{};
        run.session = session.name;
        run.step = step;
        run.sound = sound.count(step) != 0 && sound[step];
        RecordedRun::Sample before;
        before.utime = before.ins.utime = us(time - 2.0);
        before.command = tracks(table, row, "wheel", session.radius);
        run.samples.push_back(before);
      }
      RecordedRun::Sample sample;
      sample.utime = sample.ins.utime = us(time);
      sample.command = tracks(table, row, "cmd", session.radius);
      sample.wheels = tracks(table, row, "wheel", session.radius);
      const auto rate = rates.find({step, std::lround(t * 20.0)});
      if (rate != rates.end()) sample.ins.yaw_rate = rate->second;
      run.samples.push_back(sample);
      run.fixes.push_back(
          {kStart + time,
           {table.number(row, "x_m"), table.number(row, "y_m"), table.number(row, "yaw_rad")},
           table.number(row, "pose_gap_s")});
    }
    finish(run, session);
  }

  static void finish(RecordedRun& run, RecordedSession& session) {
    Fusion::fuse(run);
    session.runs.push_back(std::move(run));
  }

  /// Gyro by step and 20ths of a second: the aligned files omit it.
  std::map<std::pair<int, long>, double> readRates(const RecordedSession& session) const {
    const recordings::CsvTable table(folder_ + "/steps/" + session.name + ".csv");
    std::map<std::pair<int, long>, double> rates;
    for (size_t row = 0; row < table.rows(); ++row)
      rates[{table.integer(row, "step"), std::lround(table.number(row, "t_s") * 20.0)}] =
          table.number(row, "imu_yaw_rate_rad_s");
    return rates;
  }

  static TrackCommand tracks(const recordings::CsvTable& table, size_t row,
                             const std::string& which, double radius) {
    return {radius * table.number(row, which + "_left_rad_s"),
            radius * table.number(row, which + "_right_rad_s")};
  }

  std::string folder_;
};

}  // namespace tread::motor
