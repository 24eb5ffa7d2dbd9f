// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "common/recordings/drive_recordings.hpp"
#include "tests/tools/robot/import/drive_samples.hpp"

// Drives on known grounds, as windows and as folders of files.
namespace tread::samples {

/// Motion for a command on a ground.
using Ground = std::function<recordings::TwistLine(const recordings::BodyCommand&)>;

/// Twists proportional to the command; sideslip proportional to the yaw rate.
inline Ground linearGround(double forward, double yaw, double slip) {
  return [=](const recordings::BodyCommand& command) {
    return recordings::TwistLine{{forward * command.v, slip * command.w, yaw * command.w},
                                 {0.0, 0.0, 0.0}};
  };
}

/// Random numbers between -1 and 1, the same on every platform.
class Draws {
 public:
  explicit Draws(uint64_t seed) : random_(seed) {}
  double next() { return static_cast<double>(random_() >> 11) / 4503599627370496.0 - 1.0; }

 private:
  std::mt19937_64 random_;
};

/// Both steady windows of steps with random commands; windows of a step differ by +-`noise` in each
/// component.
inline std::vector<recordings::SteadyWindow> drawnWindows(const Ground& ground, int steps,
                                                          double noise, uint64_t seed) {
  Draws draws(seed);
  std::vector<recordings::SteadyWindow> windows;
  for (int step = 1; step <= steps; ++step) {
    const recordings::BodyCommand command{4.0 * draws.next(), 4.0 * draws.next()};
    const auto profile = ground(command).vector();
    Eigen::Matrix<double, 6, 1> off;
    for (int i = 0; i < 6; ++i) off[i] = noise * draws.next();
    windows.push_back({"drawn", step, 1, command, recordings::TwistLine::of(profile + off)});
    windows.push_back({"drawn", step, 2, command, recordings::TwistLine::of(profile - off)});
  }
  return windows;
}

/// One session of a folder of drives.
struct DrivenSession {
  std::string name;
  std::string robot;
  std::string surface;
  Ground ground;
  int steps = 24;
  double largest_v = 4.5;  ///< [m/s] of its commands
  double largest_w = 4.0;  ///< [rad/s]
};

constexpr double kRadius = 0.3;
constexpr double kBaseline = 1.0;
constexpr double kLag = 0.2;

/// Rows of one step of 6 s: steady from the start, a pose every 0.2 s, delayed by the lag.
inline std::string drivenRows(int step, const recordings::BodyCommand& command,
                              const Ground& ground) {
  const TrackCommand tracks = recordings::trackCommand(command, kBaseline);
  const Twist2 twist = ground(command).mean;
  std::string rows;
  Pose2 held;
  for (int i = 0; i <= 120; ++i) {
    const double t = 0.05 * i;
    const bool fresh = i % 4 == 0;
    if (fresh) held = integrate(twist, t - kLag);
    rows += line("%d,%d,%.3f,%.5f,%.5f,%.6f,%.6f,%.6f,%d\n", step, std::min(2, i / 40), t,
                 tracks.left / kRadius, tracks.right / kRadius, held.x, held.y, held.yaw,
                 fresh ? 1 : 0);
  }
  return rows;
}

inline const char* kDrivenStepsHeader =
    "step,window,t_s,cmd_left_rad_s,cmd_right_rad_s,x_m,y_m,yaw_rad,pose_new\n";
inline const char* kDrivenQualityHeader = "session,step,cmd_left_rad_s,cmd_right_rad_s,ok\n";
inline const char* kDrivenSessionsHeader =
    "session,robot,surface,wheel_radius_m,baseline_m,pose_lag_s\n";

/// Writes a folder of drives in the tools' format; returns its path.
inline std::string writeDrives(const Folder& folder, const std::vector<DrivenSession>& sessions) {
  std::string table = kDrivenSessionsHeader;
  std::string quality = kDrivenQualityHeader;
  std::filesystem::create_directories(folder.file("steps"));
  for (const DrivenSession& session : sessions) {
    Draws draws(7);
    std::string rows = kDrivenStepsHeader;
    table += line("%s,\"%s\",\"%s\",%.3f,%.3f,%.2f\n", session.name.c_str(), session.robot.c_str(),
                  session.surface.c_str(), kRadius, kBaseline, kLag);
    for (int step = 1; step <= session.steps; ++step) {
      const recordings::BodyCommand command{session.largest_v * draws.next(),
                                            session.largest_w * draws.next()};
      const TrackCommand tracks = recordings::trackCommand(command, kBaseline);
      quality += line("%s,%d,%.5f,%.5f,1\n", session.name.c_str(), step, tracks.left / kRadius,
                      tracks.right / kRadius);
      rows += drivenRows(step, command, session.ground);
    }
    folder.file("steps/" + session.name + ".csv", rows);
  }
  folder.file("steps_quality.csv", quality);
  return std::filesystem::path(folder.file("sessions.csv", table)).parent_path().string();
}

}  // namespace tread::samples
