// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/track.hpp"
#include "common/pattern/pattern.hpp"
#include "common/recordings/twist_line.hpp"

// A folder of recorded drives: sessions.csv (robot, surface, geometry, lag of the poses),
// steps_quality.csv (each held command, and whether its step is usable), steps/SESSION.csv (the
// drive at 20 Hz, by step and window). Other columns and files are ignored. Units: m, rad, s.
namespace tread::recordings {

// The body twist over a steady window of T seconds as a line in time:
//   v_x(t) = v_x + v_x' (t - T/2), the same for v_y and omega, so that
//   yaw(t) = yaw_0 + integral of omega (quadratic in t), and
//   p(t)   = p_0 + integral of R(yaw(s)) (v_x(s), v_y(s)) ds.
// Given yaw(t) the second is linear in p_0, v_x, v_x', v_y, v_y': two robust linear least squares.

/// [s] after a command its motion is steady: a delay of 0.4 s and four time constants of 0.35 s, as
/// for skid-steer robots of 70 to 500 kg. Earlier measurements are not used.
inline constexpr double kSettle = 1.8;

/// A wheel command as body motion of an ideal differential drive.
struct BodyCommand {
  double v = 0.0;  ///< [m/s] + forward
  double w = 0.0;  ///< [rad/s] + counter-clockwise
};

/// One held command of a session.
struct CommandStep {
  int number = 0;
  TrackCommand tracks;  ///< [m/s] of the wheels' rims, as commanded
  bool ok = false;
};

/// One recording as described by the tables.
struct Session {
  std::string name;
  std::string robot;
  std::string surface;
  double wheel_radius = 0.0;  ///< [m]
  double baseline = 0.0;      ///< [m] converts (v, w) commands to wheel speeds
  double pose_lag = 0.0;      ///< [s] poses are logged this much after they were measured
  // Of sessions.csv, for the import; readSessions() leaves them.
  bool lag_kept = false;   ///< poses stay where they were logged; pose_lag is 0 then
  double pose_rate = 0.0;  ///< [Hz]
  double imu_sign = 1.0;   ///< sign of the gyro in raw files that makes counter-clockwise positive
  /// Roll and pitch are in the map frame, not relative within a step
  bool absolute_attitude = false;
  size_t rows = 0;  ///< of the steps file
  // Of readSessions() alone.
  std::string problem;             ///< why its row cannot be used, in words; empty if usable
  std::vector<CommandStep> steps;  ///< as steps_quality.csv lists them

  size_t okSteps() const;
};

/// A row of sessions.csv; throws RecordingError with one clear line.
Session readSession(const std::string& sessions_path, const std::string& name);

/// (v, w) of an ideal differential drive of this baseline.
BodyCommand bodyCommand(const TrackCommand& tracks, double baseline);
/// And back.
TrackCommand trackCommand(const BodyCommand& command, double baseline);

/// All sessions of a folder, in the order of sessions.csv.
/** Throws RecordingError with one clear line for a file that is missing or damaged. */
std::vector<Session> readSessions(const std::string& folder);

/// A steady window of a command step, smoothed.
struct SteadyWindow {
  std::string session;
  int step = 0;         ///< number of the command in its session
  int window = 0;       ///< 1 or 2 within its step
  BodyCommand command;  ///< by the reference baseline of the robot
  TwistLine profile;
};

/// The steady windows (1 and 2) of a session, with counts of those left out, by reason.
struct SessionWindows {
  std::vector<SteadyWindow> used;
  std::map<std::string, int> left_out;
};

/// Reads steps/SESSION.csv and smooths its steady windows; commands use the robot's reference
/// baseline.
/** A window's poses are its own rows with a new pose, except for the first row, where windows were
 * joined. They were measured one pose lag before they were logged, so that a window of [t, t + T]
 * describes [t - lag, t + T - lag]; the part before the motion has settled is not used. The
 * profile is centred on the rest. Throws RecordingError. */
SessionWindows readWindows(const std::string& folder, const Session& session, double baseline,
                           double duration);

/// The robot that matches a part of its name: the whole name first, then its beginning, then any
/// part.
/** Case-insensitive; empty means the only robot. Throws RecordingError with the list of robots if
 * none or several match. */
std::string chooseRobot(const std::vector<Session>& sessions, const std::string& wanted);

/// Sessions that are comparable.
struct SessionChoice {
  std::vector<Session> taken;  ///< in the order of sessions.csv
  /// A line with the reason for each other session of the robot
  std::vector<std::string> left_out;
  double baseline = 0.0;  ///< [m] converts (v, w) to wheel speeds
};

/// A session with fewer usable steps is not compared with others.
inline constexpr size_t kLeastSteps = 20;

/// |v| and |w| that 95 % of a session's ok commands do not exceed.
BodyCommand reachOf(const Session& session);

/// All sessions of the robot whose commands cover those of the patterns, on wheels of the same
/// geometry.
SessionChoice comparableSessions(const std::vector<Session>& sessions, const std::string& robot,
                                 const BodyCommand& needed);

/// Exactly these sessions. Throws RecordingError for a name that is not one of the robot's
/// sessions.
SessionChoice namedSessions(const std::vector<Session>& sessions, const std::string& robot,
                            const std::vector<std::string>& names);

/// Surfaces of sessions, each once, in their order.
std::vector<std::string> surfacesOf(const std::vector<Session>& sessions);

}  // namespace tread::recordings
