// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/recordings/sessions.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "common/recordings/csv_table.hpp"
#include "common/report/text.hpp"
#include "common/statistics/statistics.hpp"

namespace tread::recordings {
namespace {

/// The fields of a session that both the import and the comparison of surfaces need.
void readGeometry(const CsvTable& table, size_t row, Session& session) {
  session.wheel_radius = table.numberWithin(row, "wheel_radius_m", 0.01, 2.0);
  session.baseline = table.numberWithin(row, "baseline_m", 0.05, 5.0);
  session.pose_lag = table.numberWithin(row, "pose_lag_s", 0.0, 2.0);
}

Session namedSession(const CsvTable& table, size_t row) {
  Session session;
  session.name = table.text(row, "session");
  session.robot = table.text(row, "robot");
  session.surface = table.text(row, "surface");
  return session;
}

void readQuality(const std::string& path, std::vector<Session>& sessions) {
  const CsvTable table(path);
  table.require({"session", "step", "cmd_left_rad_s", "cmd_right_rad_s", "ok"});
  for (size_t row = 0; row < table.rows(); ++row) {
    const auto session = std::find_if(sessions.begin(), sessions.end(), [&](const Session& s) {
      return s.name == table.text(row, "session");
    });
    if (session == sessions.end() || !session->problem.empty()) continue;
    CommandStep step{table.integer(row, "step"), {}, table.text(row, "ok") == "1"};
    // An unusable step may lack numbers.
    if (step.ok)
      step.tracks = {session->wheel_radius * table.number(row, "cmd_left_rad_s"),
                     session->wheel_radius * table.number(row, "cmd_right_rad_s")};
    session->steps.push_back(step);
  }
}

/// Poses of a window, by their time in its settled part.
struct SettledPoses {
  std::vector<PoseSample> poses;
  double duration = 0.0;  ///< [s] of that part
};

/// New poses of the rows (first, last) that were measured after `settle`.
SettledPoses posesOf(const CsvTable& table, size_t first, size_t last, double lag,
                     double duration) {
  const double logged = table.number(first, "t_s");
  const double begin = std::max(logged - lag, kSettle);
  SettledPoses settled;
  settled.duration = logged + duration - lag - begin;
  double before = logged;
  for (size_t row = first + 1; row < last; ++row) {
    const double time = table.number(row, "t_s");
    if (time <= before)
      throw table.error(row, "t_s does not grow within the window; are the rows in order?");
    before = time;
    const double measured = time - lag - begin;
    if (table.integer(row, "pose_new") == 0 || measured < -1e-9) continue;
    settled.poses.push_back(
        {measured,
         {table.number(row, "x_m"), table.number(row, "y_m"), table.number(row, "yaw_rad")}});
  }
  return settled;
}

/// Sorts windows into those used and those left out.
class WindowReader {
 public:
  WindowReader(const Session& session, double baseline) : session_(session), baseline_(baseline) {}

  void take(int step_number, int window, const SettledPoses& settled) {
    const auto step = std::find_if(session_.steps.begin(), session_.steps.end(),
                                   [&](const CommandStep& s) { return s.number == step_number; });
    if (step == session_.steps.end()) return leaveOut("step is not in steps_quality.csv");
    if (!step->ok) return leaveOut("step is not ok in steps_quality.csv");
    const std::string problem = windowProblem(settled.poses, settled.duration);
    if (!problem.empty()) return leaveOut(problem);
    result.used.push_back({session_.name, step_number, window, bodyCommand(step->tracks, baseline_),
                           smoothed(settled.poses, settled.duration)});
  }

  SessionWindows result;

 private:
  void leaveOut(const std::string& reason) { ++result.left_out[reason]; }

  const Session& session_;
  double baseline_;
};

constexpr double kReachQuantile = 0.95;      // of |v| and |w| of a session
constexpr double kGeometryTolerance = 0.02;  // of radius and baseline between sessions

std::string lowered(std::string text) {
  for (char& letter : text)
    letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return text;
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "'" : ", '") + name + "'";
  return text;
}

/// The different values of a field over the sessions, in their order.
std::vector<std::string> distinct(const std::vector<Session>& sessions,
                                  std::string Session::*field) {
  std::vector<std::string> values;
  for (const Session& session : sessions)
    if (std::find(values.begin(), values.end(), session.*field) == values.end())
      values.push_back(session.*field);
  return values;
}

bool sameGeometry(const Session& a, const Session& b) {
  return std::abs(a.baseline - b.baseline) <= kGeometryTolerance * b.baseline &&
         std::abs(a.wheel_radius - b.wheel_radius) <= kGeometryTolerance * b.wheel_radius;
}

/// The session with the geometry that most ok steps have.
const Session& ofUsualGeometry(const std::vector<Session>& sessions) {
  size_t best = 0;
  size_t most = 0;
  for (size_t i = 0; i < sessions.size(); ++i) {
    size_t steps = 0;
    for (const Session& other : sessions)
      if (sameGeometry(other, sessions[i])) steps += other.okSteps();
    if (steps <= most) continue;
    most = steps;
    best = i;
  }
  return sessions[best];
}

/// Why a session's commands are too small, in words; empty if they suffice.
std::string commandProblem(const Session& session, const BodyCommand& needed) {
  if (!session.problem.empty()) return session.problem;
  if (session.okSteps() < kLeastSteps)
    return "has " + std::to_string(session.okSteps()) + " ok steps, needed " +
           std::to_string(kLeastSteps);
  const BodyCommand reach = reachOf(session);
  if (reach.v < needed.v || reach.w < needed.w)
    return "commands reach " + fixed(reach.v, 2) + " m/s and " + fixed(reach.w, 2) +
           " rad/s, the patterns need " + fixed(needed.v, 2) + " and " + fixed(needed.w, 2);
  return "";
}

std::string leftOut(const Session& session, const std::string& why) {
  return session.name + " (" + session.surface + "): " + why;
}

}  // namespace

size_t Session::okSteps() const {
  return static_cast<size_t>(
      std::count_if(steps.begin(), steps.end(), [](const CommandStep& step) { return step.ok; }));
}

BodyCommand bodyCommand(const TrackCommand& tracks, double baseline) {
  return {(tracks.left + tracks.right) / 2.0, (tracks.right - tracks.left) / baseline};
}

TrackCommand trackCommand(const BodyCommand& command, double baseline) {
  const double half = command.w * baseline / 2.0;
  return {command.v - half, command.v + half};
}

std::vector<Session> readSessions(const std::string& folder) {
  const CsvTable table(folder + "/sessions.csv");
  table.require({"session", "robot", "surface", "wheel_radius_m", "baseline_m", "pose_lag_s"});
  std::vector<Session> sessions;
  for (size_t row = 0; row < table.rows(); ++row) {
    sessions.push_back(namedSession(table, row));
    // A session with missing numbers is skipped; the others are kept.
    try {
      readGeometry(table, row, sessions.back());
    } catch (const RecordingError& error) {
      sessions.back().problem = error.what();
    }
  }
  readQuality(folder + "/steps_quality.csv", sessions);
  return sessions;
}

SessionWindows readWindows(const std::string& folder, const Session& session, double baseline,
                           double duration) {
  const std::string path = folder + "/steps/" + session.name + ".csv";
  const CsvTable table(path);
  table.require({"step", "window", "t_s", "x_m", "y_m", "yaw_rad", "pose_new"});
  WindowReader reader(session, baseline);
  for (size_t row = 0; row < table.rows();) {
    const int step = table.integer(row, "step");
    const int window = table.integer(row, "window");
    size_t last = row + 1;
    while (last < table.rows() && table.integer(last, "step") == step &&
           table.integer(last, "window") == window)
      ++last;
    if (window == 1 || window == 2)
      reader.take(step, window, posesOf(table, row, last, session.pose_lag, duration));
    row = last;
  }
  return std::move(reader.result);
}

Session readSession(const std::string& sessions_path, const std::string& name) {
  const CsvTable table(sessions_path);
  for (size_t row = 0; row < table.rows(); ++row) {
    if (table.text(row, "session") != name) continue;
    Session session = namedSession(table, row);
    readGeometry(table, row, session);
    session.pose_rate = table.numberWithin(row, "pose_rate_hz", 0.5, 200.0);
    session.imu_sign = table.numberWithin(row, "imu_sign_applied", -1.0, 1.0);
    session.absolute_attitude = table.text(row, "roll_pitch").rfind("absolute", 0) == 0;
    session.rows = static_cast<size_t>(table.integer(row, "n_rows"));
    return session;
  }
  throw RecordingError(sessions_path + ": no session " + name +
                       "; its radius and pose lag are needed (--session NAME names another row)");
}

std::string chooseRobot(const std::vector<Session>& sessions, const std::string& wanted) {
  const std::vector<std::string> robots = distinct(sessions, &Session::robot);
  const std::string key = lowered(wanted);
  std::vector<std::string> prefixed;
  std::vector<std::string> containing;
  for (const std::string& robot : robots) {
    const std::string name = lowered(robot);
    if (name == key) return robot;
    if (name.rfind(key, 0) == 0) prefixed.push_back(robot);
    if (name.find(key) != std::string::npos) containing.push_back(robot);
  }
  const std::vector<std::string>& meant = prefixed.empty() ? containing : prefixed;
  if (meant.size() == 1) return meant.front();
  if (wanted.empty())
    throw RecordingError("sessions of several robots; choose one with --robot: " + listed(robots));
  if (meant.empty())
    throw RecordingError("no robot is called '" + wanted + "'; there are " + listed(robots));
  throw RecordingError("'" + wanted + "' may be any of " + listed(meant) +
                       "; give more of the name");
}

BodyCommand reachOf(const Session& session) {
  std::vector<double> v;
  std::vector<double> w;
  for (const CommandStep& step : session.steps) {
    if (!step.ok) continue;
    const BodyCommand command = bodyCommand(step.tracks, session.baseline);
    v.push_back(std::abs(command.v));
    w.push_back(std::abs(command.w));
  }
  return {lowerQuantile(std::move(v), kReachQuantile, 0.0),
          lowerQuantile(std::move(w), kReachQuantile, 0.0)};
}

SessionChoice comparableSessions(const std::vector<Session>& sessions, const std::string& robot,
                                 const BodyCommand& needed) {
  SessionChoice choice;
  std::vector<Session> able;
  for (const Session& session : sessions) {
    if (session.robot != robot) continue;
    const std::string problem = commandProblem(session, needed);
    if (problem.empty())
      able.push_back(session);
    else
      choice.left_out.push_back(leftOut(session, problem));
  }
  if (able.empty()) return choice;
  const Session usual = ofUsualGeometry(able);
  choice.baseline = usual.baseline;
  for (const Session& session : able) {
    if (sameGeometry(session, usual)) {
      choice.taken.push_back(session);
      continue;
    }
    choice.left_out.push_back(
        leftOut(session, "wheel radius " + fixed(session.wheel_radius, 3) + " m and baseline " +
                             fixed(session.baseline, 3) + " m, most steps of this robot have " +
                             fixed(usual.wheel_radius, 3) + " and " + fixed(usual.baseline, 3) +
                             ": another set-up (--sessions takes it all the same)"));
  }
  return choice;
}

SessionChoice namedSessions(const std::vector<Session>& sessions, const std::string& robot,
                            const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const Session& session : sessions)
    if (session.robot == robot) known.push_back(session.name);
  for (const std::string& name : names)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw RecordingError("no session '" + name + "' of " + robot + "; there are " +
                           listed(known));
  SessionChoice choice;
  for (const Session& session : sessions) {
    if (session.robot != robot) continue;
    const bool named = std::find(names.begin(), names.end(), session.name) != names.end();
    if (named && !session.problem.empty()) throw RecordingError(session.problem);
    if (named)
      choice.taken.push_back(session);
    else
      choice.left_out.push_back(leftOut(session, "was not asked for"));
  }
  if (!choice.taken.empty()) choice.baseline = ofUsualGeometry(choice.taken).baseline;
  return choice;
}

std::vector<std::string> surfacesOf(const std::vector<Session>& sessions) {
  return distinct(sessions, &Session::surface);
}

}  // namespace tread::recordings
