// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "tests/common/recordings/synthetic_drives.hpp"
#include "tools/lab/experiment/adaptation/reference.hpp"

// Driving on known ground: random commands, each held for six seconds.
namespace tread::adaptation {

/// Motion for lagged commands on a ground.
struct DrawnGround {
  double forward = 0.95;  ///< [1]
  double yaw = 0.5;       ///< [1]
  double slip = 0.0;      ///< [s] v_y per v w
};

inline std::vector<recordings::BodyCommand> drawnCommands(int steps, uint64_t seed) {
  samples::Draws draws(seed);
  std::vector<recordings::BodyCommand> commands;
  for (int i = 0; i < steps; ++i) commands.push_back({2.0 * draws.next(), 2.0 * draws.next()});
  return commands;
}

/// A session of so many steps; executions scatter by `noise` (uniform, relative), which changes
/// every second.
inline SampledSession drawnSession(const std::string& name, const std::string& surface,
                                   const DrawnGround& ground, int steps, double noise,
                                   uint64_t seed) {
  SampledSession session;
  session.name = name;
  session.vehicle = "drawn";
  session.surface = surface;
  SampledSegment segment;
  segment.entry_known = true;
  for (const recordings::BodyCommand& command : drawnCommands(steps, seed))
    for (int i = 0; i < 120; ++i)
      segment.commands.push_back(recordings::trackCommand(command, session.baseline));
  samples::Draws draws(seed + 1000);
  Pose2 at;
  segment.poses.push_back(at);
  double forward = 1.0, yaw = 1.0;
  size_t t = 0;
  for (const Eigen::Vector2d& motion : lagged(segment, session.baseline, {0.2, 0.3})) {
    if (t++ % 20 == 0) {
      forward = 1.0 + noise * draws.next();
      yaw = 1.0 + noise * draws.next();
    }
    const double v = ground.forward * forward * motion[0];
    const double w = ground.yaw * yaw * motion[1];
    at = at * integrate({v, ground.slip * v * w, w}, kPeriod);
    segment.poses.push_back(at);
  }
  session.segments.push_back(std::move(segment));
  cutPieces(session);
  return session;
}

/// A session for a folder of drives.
struct WrittenSession {
  std::string name;
  std::string surface;
  int steps = 16;
  double yaw = 0.5;       ///< [1] gain of the ground
  int bad_step = 0;       ///< is not ok
  int operator_step = 0;  ///< the operator drove before it: wheel speeds differ
};

/// Writes sessions in steps format: wheels follow at once, poses every 0.1 s, 0.2 s late.
inline std::string writeDriving(const samples::Folder& folder,
                                const std::vector<WrittenSession>& sessions) {
  using samples::line;
  std::string table =
      "session,robot,surface,wheel_radius_m,baseline_m,n_rows,pose_lag_s,pose_rate_hz,"
      "imu_sign_applied,roll_pitch\n";
  std::string quality = "session,step,cmd_left_rad_s,cmd_right_rad_s,ok\n";
  std::filesystem::create_directories(folder.file("steps"));
  uint64_t seed = 1;
  for (const WrittenSession& session : sessions) {
    const auto commands = drawnCommands(session.steps, seed++);
    constexpr int kRows = 121;  // 6.05 s
    constexpr int kLate = 4;    // samples
    std::vector<Pose2> truth{{}};
    for (const recordings::BodyCommand& command : commands)
      for (int i = 0; i < kRows; ++i)
        truth.push_back(truth.back() *
                        integrate({0.95 * command.v, 0.0, session.yaw * command.w}, kPeriod));
    const auto logged = [&](int row) {  // the newest pose, held between updates
      const int measured = std::max(0, row - kLate) / 2 * 2;
      return truth[static_cast<size_t>(measured)];
    };
    std::string rows = samples::kStepsHeader;
    for (int step = 1; step <= session.steps; ++step) {
      const TrackCommand tracks =
          recordings::trackCommand(commands[static_cast<size_t>(step - 1)], 1.0);
      quality += line("%s,%d,%.6f,%.6f,%d\n", session.name.c_str(), step, tracks.left / 0.5,
                      tracks.right / 0.5, step == session.bad_step ? 0 : 1);
      const int first = (step - 1) * kRows;
      const TrackCommand before =
          step == 1 ? tracks
                    : recordings::trackCommand(commands[static_cast<size_t>(step - 2)], 1.0);
      const TrackCommand wheels = step == session.operator_step ? TrackCommand{} : before;
      for (int i = 0; i < kRows; ++i) {
        const Pose2 pose = between(logged(first), logged(first + i));
        const bool fresh = i > 0 && (first + i) % 2 == 0 && first + i > kLate;
        const TrackCommand& turned = i == 0 ? wheels : tracks;
        rows += line("%d,0,%.3f,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,0,0,0,%d,0,0\n", step,
                     kPeriod * i, tracks.left / 0.5, tracks.right / 0.5, turned.left / 0.5,
                     turned.right / 0.5, pose.x, pose.y, pose.yaw, fresh ? 1 : 0);
      }
    }
    table += line("%s,drawn robot,%s,0.5,1.0,%d,0.2,10.0,1,relative\n", session.name.c_str(),
                  session.surface.c_str(), kRows * session.steps);
    folder.file("steps/" + session.name + ".csv", rows);
  }
  folder.file("steps_quality.csv", quality);
  return std::filesystem::path(folder.file("sessions.csv", table)).parent_path().string();
}

}  // namespace tread::adaptation
