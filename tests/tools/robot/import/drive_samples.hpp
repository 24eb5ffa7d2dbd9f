// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <unistd.h>

#include <cstdarg>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "common/log/event_log.hpp"

// Small synthetic recordings in the three formats.
namespace tread::samples {

/// A temporary folder.
class Folder {
 public:
  explicit Folder(const std::string& name)
      : path_(std::filesystem::temp_directory_path() /
              ("tread_" + std::to_string(::getpid()) + "_" + name)) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::string file(const std::string& name, const std::string& content = "") const {
    const std::string path = (path_ / name).string();
    if (!content.empty()) std::ofstream(path) << content;
    return path;
  }

 private:
  std::filesystem::path path_;
};

inline std::string line(const char* format, ...) __attribute__((format(printf, 1, 2)));
inline std::string line(const char* format, ...) {
  char text[400];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return text;
}

/// sessions.csv with one robot: radius 0.5 m, baseline 1.0 m, lag 0.2 s, 10 Hz.
inline std::string sessions(int rows) {
  return "session,robot,surface,wheel_radius_m,baseline_m,n_rows,pose_lag_s,pose_rate_hz,"
         "imu_sign_applied,roll_pitch\n" +
         line("drive,\"Some robot, 100 kg\",gravel,0.5,1.0,%d,0.2,10.0,1,relative to step start\n",
              rows);
}

inline const char* kStepsHeader =
    "step,window,t_s,cmd_left_rad_s,cmd_right_rad_s,wheel_left_rad_s,wheel_right_rad_s,x_m,y_m,"
    "yaw_rad,z_m,roll_rad,pitch_rad,pose_new,imu_yaw_rate_rad_s,join\n";

/// Rows of one step of 6 s in steps format: 1 m/s straight, a new pose every 0.1 s.
inline std::string stepRows(int step) {
  std::string rows;
  for (int i = 0; i <= 120; ++i) {
    const double t = 0.05 * i;
    const double x = 1.0 * (i / 2) * 0.1;
    rows += line("%d,0,%.3f,2.0,4.0,1.9,3.9,%.4f,0.0,0.0,0.0,0.0,0.0,%d,%.4f,0\n", step, t, x,
                 i % 2 == 0 ? 1 : 0, t);
  }
  return rows;
}

/// Rows of one step in aligned format, with an ICP gap of 0.5 s between 2.0 and 2.5 s.
inline std::string alignedRows(int step) {
  std::string rows;
  for (int i = 0; i <= 110; ++i) {
    const double t = 0.05 * i;
    const double gap = t > 2.001 && t < 2.499 ? 0.5 : 0.1;
    rows += line("%d,%.2f,2.0,4.0,1.9,3.9,%.4f,0.0,0.0,%.2f\n", step, t, t, gap);
  }
  return rows;
}
inline const char* kAlignedHeader =
    "step,t_s,cmd_left_rad_s,cmd_right_rad_s,wheel_left_rad_s,wheel_right_rad_s,x_m,y_m,yaw_rad,"
    "pose_gap_s\n";

inline const char* kContinuousHeader =
    "t_s,unix_s,state,step,cmd_v_m_s,cmd_w_rad_s,wheel_left_rad_s,wheel_right_rad_s,map_x_m,"
    "map_y_m,map_z_m,map_roll_rad,map_pitch_rad,map_yaw_rad,pose_new,imu_wz_rad_s,volt_left,"
    "volt_right,current_left,current_right\n";

/// Two seconds by the operator, step 1 for 4 s until he takes over, idle for 1 s, step 2 for 6 s.
inline std::string continuousRows() {
  std::string rows;
  for (int i = 0; i < 260; ++i) {
    const double t = 0.05 * i;
    const bool first = i >= 40 && i < 120;
    const bool second = i >= 140;
    rows += line("%.4f,%.3f,%s,%d,%.4f,%.4f,1.0,1.0,%.4f,2.0,0.5,0.01,0.10,0.3,%d,0.2,%s,3.0,5.0\n",
                 t, 1.7e9 + t, first || second ? "calib" : "idle", second ? 2 : 1,
                 first || second ? 1.0 : 0.0, second ? 0.5 : 0.0, t, i % 2,
                 i < 60 ? "0.0,0.0" : "48.0,49.0");
  }
  return rows;
}

/// All messages of a channel, decoded.
template <class Message>
std::vector<Message> messagesOn(const Channel<Message>& channel,
                                const std::vector<LogEvent>& events) {
  std::vector<Message> messages;
  for (const LogEvent& event : events) {
    Message message;
    if (decode(event, channel, message)) messages.push_back(message);
  }
  return messages;
}

}  // namespace tread::samples
