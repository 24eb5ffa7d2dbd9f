// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/recordings/drive_folder.hpp"

#include <algorithm>
#include <cmath>

#include "common/recordings/csv_table.hpp"

namespace tread::drive_patterns {
namespace {

using importer::CsvTable;
using importer::ImportError;

/// Columns that a table must have; further ones do not matter.
void requireColumns(const CsvTable& table, const std::string& path,
                    const std::vector<std::string>& names) {
  for (const std::string& name : names) try {
      table.column(name);
    } catch (const ImportError&) {
      std::string all;
      for (const std::string& each : names) all += (all.empty() ? "" : ", ") + each;
      throw ImportError(path + ":1: no column " + name + "; needed are " + all);
    }
}

double within(const CsvTable& table, size_t row, const std::string& name, double min, double max) {
  const double value = table.number(row, table.column(name));
  if (value < min || value > max)
    throw table.error(row, "column " + name + " is " + table.text(row, table.column(name)) +
                               "; allowed is " + std::to_string(min) + " to " +
                               std::to_string(max));
  return value;
}

DriveSession sessionOf(const CsvTable& table, size_t row) {
  DriveSession session;
  session.name = table.text(row, table.column("session"));
  session.robot = table.text(row, table.column("robot"));
  session.surface = table.text(row, table.column("surface"));
  // A session without its numbers is of no use, but the others are.
  try {
    session.wheel_radius = within(table, row, "wheel_radius_m", 0.01, 2.0);
    session.baseline = within(table, row, "baseline_m", 0.05, 5.0);
    session.pose_lag = within(table, row, "pose_lag_s", 0.0, 2.0);
  } catch (const ImportError& error) {
    session.problem = error.what();
  }
  return session;
}

void readSteps(const std::string& path, std::vector<DriveSession>& sessions) {
  const CsvTable table(path);
  requireColumns(table, path, {"session", "step", "cmd_left_rad_s", "cmd_right_rad_s", "ok"});
  const size_t name = table.column("session");
  const size_t step = table.column("step");
  const size_t left = table.column("cmd_left_rad_s");
  const size_t right = table.column("cmd_right_rad_s");
  const size_t ok = table.column("ok");
  for (size_t row = 0; row < table.rows(); ++row) {
    const auto session = std::find_if(sessions.begin(), sessions.end(), [&](const DriveSession& s) {
      return s.name == table.text(row, name);
    });
    if (session == sessions.end() || !session->problem.empty()) continue;
    // What is not fit for use may lack numbers, too.
    if (table.text(row, ok) != "1") {
      session->steps.push_back({table.integer(row, step), {}, false});
      continue;
    }
    const double radius = session->wheel_radius;
    session->steps.push_back({table.integer(row, step),
                              {radius * table.number(row, left), radius * table.number(row, right)},
                              true});
  }
}

struct StepColumns {
  explicit StepColumns(const CsvTable& table)
      : step(table.column("step")),
        window(table.column("window")),
        time(table.column("t_s")),
        x(table.column("x_m")),
        y(table.column("y_m")),
        yaw(table.column("yaw_rad")),
        fresh(table.column("pose_new")) {}
  size_t step, window, time, x, y, yaw, fresh;
};

/// Poses of a window, by their time in the part of it that is used.
struct SettledPoses {
  std::vector<WindowPose> poses;
  double duration = 0.0;  ///< [s] of that part
};

/// New poses of the rows (first, last) that were measured after `settle`.
SettledPoses posesOf(const CsvTable& table, const StepColumns& columns, size_t first, size_t last,
                     double lag, double duration, double settle) {
  const double logged = table.number(first, columns.time);
  const double begin = std::max(logged - lag, settle);
  SettledPoses settled;
  settled.duration = logged + duration - lag - begin;
  double before = logged;
  for (size_t row = first + 1; row < last; ++row) {
    const double time = table.number(row, columns.time);
    if (time <= before)
      throw table.error(row, "t_s does not grow within the window; are the rows in order?");
    before = time;
    const double measured = time - lag - begin;
    if (table.integer(row, columns.fresh) == 0 || measured < -1e-9) continue;
    settled.poses.push_back({measured,
                             {table.number(row, columns.x), table.number(row, columns.y),
                              table.number(row, columns.yaw)}});
  }
  return settled;
}

/// Sorts windows into those used and those left out.
class WindowReader {
 public:
  WindowReader(const DriveSession& session, double baseline, const SmoothingLimits& limits)
      : session_(session), baseline_(baseline), limits_(limits) {}

  void take(int step_number, int window, const SettledPoses& settled) {
    const auto step = std::find_if(session_.steps.begin(), session_.steps.end(),
                                   [&](const CommandStep& s) { return s.number == step_number; });
    if (step == session_.steps.end()) return leaveOut("step is not in steps_quality.csv");
    if (!step->ok) return leaveOut("step is not ok in steps_quality.csv");
    const std::string problem = windowProblem(settled.poses, settled.duration, limits_);
    if (!problem.empty()) return leaveOut(problem);
    result.used.push_back({session_.name, step_number, window, bodyCommand(step->tracks, baseline_),
                           smoothed(settled.poses, settled.duration, limits_)});
  }

  SessionWindows result;

 private:
  void leaveOut(const std::string& reason) { ++result.left_out[reason]; }

  const DriveSession& session_;
  double baseline_;
  const SmoothingLimits& limits_;
};

}  // namespace

size_t DriveSession::okSteps() const {
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

std::vector<DriveSession> readSessions(const std::string& folder) {
  const std::string path = folder + "/sessions.csv";
  const CsvTable table(path);
  requireColumns(table, path,
                 {"session", "robot", "surface", "wheel_radius_m", "baseline_m", "pose_lag_s"});
  std::vector<DriveSession> sessions;
  for (size_t row = 0; row < table.rows(); ++row) sessions.push_back(sessionOf(table, row));
  readSteps(folder + "/steps_quality.csv", sessions);
  return sessions;
}

SessionWindows readWindows(const std::string& folder, const DriveSession& session, double baseline,
                           double duration, const SmoothingLimits& limits) {
  const std::string path = folder + "/steps/" + session.name + ".csv";
  const CsvTable table(path);
  requireColumns(table, path, {"step", "window", "t_s", "x_m", "y_m", "yaw_rad", "pose_new"});
  const StepColumns columns(table);
  WindowReader reader(session, baseline, limits);
  for (size_t row = 0; row < table.rows();) {
    const int step = table.integer(row, columns.step);
    const int window = table.integer(row, columns.window);
    size_t last = row + 1;
    while (last < table.rows() && table.integer(last, columns.step) == step &&
           table.integer(last, columns.window) == window)
      ++last;
    if (window == 1 || window == 2)
      reader.take(step, window,
                  posesOf(table, columns, row, last, session.pose_lag, duration, limits.settle));
    row = last;
  }
  return std::move(reader.result);
}

}  // namespace tread::drive_patterns
