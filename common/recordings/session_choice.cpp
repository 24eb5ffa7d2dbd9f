// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cctype>
#include <cmath>

#include "common/recordings/csv_table.hpp"
#include "common/recordings/sessions.hpp"
#include "common/report/text.hpp"

namespace tread::recordings {
namespace {

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

double quantileOf(std::vector<double> values, double quantile) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<size_t>(quantile * static_cast<double>(values.size() - 1))];
}

std::vector<std::string> robotsOf(const std::vector<Session>& sessions) {
  std::vector<std::string> robots;
  for (const Session& session : sessions)
    if (std::find(robots.begin(), robots.end(), session.robot) == robots.end())
      robots.push_back(session.robot);
  return robots;
}

bool sameGeometry(const Session& a, const Session& b) {
  return std::abs(a.baseline - b.baseline) <= kGeometryTolerance * b.baseline &&
         std::abs(a.wheel_radius - b.wheel_radius) <= kGeometryTolerance * b.wheel_radius;
}

/// The session whose geometry is that of most ok steps.
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

/// Why a session's commands are not enough, in words; empty if they are.
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

std::string chooseRobot(const std::vector<Session>& sessions, const std::string& wanted) {
  const std::vector<std::string> robots = robotsOf(sessions);
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
                       "; say more of the name");
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
  return {quantileOf(v, kReachQuantile), quantileOf(w, kReachQuantile)};
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
  std::vector<std::string> surfaces;
  for (const Session& session : sessions)
    if (std::find(surfaces.begin(), surfaces.end(), session.surface) == surfaces.end())
      surfaces.push_back(session.surface);
  return surfaces;
}

}  // namespace tread::recordings
