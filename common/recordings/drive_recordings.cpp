// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/recordings/drive_recordings.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "common/config/problem_words.hpp"
#include "common/recordings/average.hpp"
#include "common/recordings/csv_table.hpp"
#include "common/report/text.hpp"

namespace tread::recordings {
namespace {

/// Rounded to micrometres and microradians, for readability.
double rounded(double value) {
  return std::round(value * 1e6) / 1e6 + 0.0;
}

Twist2 rounded(const Twist2& twist) {
  return {rounded(twist.v_x), rounded(twist.v_y), rounded(twist.omega)};
}

/// Mean over the surfaces of a pattern's profile.
TwistLine meanProfile(const std::vector<SurfaceSummary>& surfaces, size_t pattern) {
  Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
  for (const SurfaceSummary& surface : surfaces) sum += surface.motions[pattern].mean.vector();
  return TwistLine::of(sum / static_cast<double>(surfaces.size()));
}

PatternSet patternSet(const std::vector<SurfaceSummary>& surfaces, const PatternRecipe& recipe,
                      double baseline) {
  PatternSetContent content;
  content.name = recipe.name;
  content.channels = trackChannels(CommandKind::kTrackSpeed);
  content.period_us = std::llround(recipe.period * 1e6);
  for (size_t p = 0; p < recipe.patterns.size(); ++p) {
    const TwistLine mean = meanProfile(surfaces, p);
    const TrackCommand exact = trackCommand(recipe.patterns[p].command, baseline);
    const TrackCommand tracks{rounded(exact.left), rounded(exact.right)};
    MotionPattern pattern;
    pattern.id = static_cast<int>(p) + 1;
    pattern.name = recipe.patterns[p].name;
    pattern.entry_class = pattern.exit_class = pattern.name;
    pattern.commands.assign(recipe.samples(), tracks);
    pattern.trajectory = integrated(mean, recipe.samples(), recipe.period);
    content.classes.push_back({pattern.name, rounded(mean.mean), tracks});
    content.patterns.push_back(std::move(pattern));
  }
  std::string why;
  auto set = PatternSet::make(std::move(content), why);
  if (!set) throw RecordingError("the recipe's patterns make no set: " + why);
  return *set;
}

SurfaceRecordings recordingsOf(const SurfaceSummary& summary, const PatternRecipe& recipe) {
  SurfaceRecordings result;
  result.surface = summary.surface;
  for (const LocalMotion& motion : summary.motions) {
    std::vector<Execution> executions;
    for (const TwistLine& profile : recordedProfiles(motion)) {
      Execution poses = integrated(profile, recipe.samples(), recipe.period);
      for (Pose2& pose : poses) pose = {rounded(pose.x), rounded(pose.y), rounded(pose.yaw)};
      executions.push_back(std::move(poses));
    }
    result.executions.push_back(std::move(executions));
  }
  return result;
}

/// A surface's motions; throws RecordingError if its windows are too few.
SurfaceSummary summarised(const SurfaceWindows& windows, const PatternRecipe& recipe) {
  SurfaceSummary summary{
      fileName(windows.surface), windows.sessions, windows.used.size(), windows.left_out, {}};
  for (const PatternWish& wish : recipe.patterns)
    summary.motions.push_back(localMotion(windows.used, wish.command, recipe));
  return summary;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : "; ") + line;
  return text;
}

/// The n-th largest reach of the surfaces' sessions, per axis.
BodyCommand commonReach(const std::vector<Session>& sessions, const std::string& robot, size_t n) {
  std::map<std::string, BodyCommand> best;
  for (const Session& session : sessions) {
    if (session.robot != robot || session.okSteps() < kLeastSteps) continue;
    const BodyCommand reach = reachOf(session);
    BodyCommand& surface = best[session.surface];
    if (reach.v * reach.w > surface.v * surface.w) surface = reach;
  }
  std::vector<double> v;
  std::vector<double> w;
  for (const auto& [name, reach] : best) {
    v.push_back(reach.v);
    w.push_back(reach.w);
  }
  if (v.size() < n || n == 0) return {};
  std::sort(v.rbegin(), v.rend());
  std::sort(w.rbegin(), w.rend());
  return {v[n - 1], w[n - 1]};
}

/// Ratio of the largest pattern commands to the largest driven ones, when fitted.
constexpr double kFittedShare = 0.6;

/// Reduces the recipe's commands if they exceed the driven ones; adds a note.
bool fitRecipe(DriveRequest& request, const BodyCommand& driven, std::vector<std::string>& notes) {
  const BodyCommand reach = request.recipe.reach();
  const bool reached = driven.v >= reach.v && driven.w >= reach.w;
  if (!request.fit_recipe || reached || driven.v <= 0.0 || driven.w <= 0.0) return false;
  const double v_factor = std::min(1.0, kFittedShare * driven.v / reach.v);
  const double w_factor = std::min(1.0, kFittedShare * driven.w / reach.w);
  notes.push_back("the robot was driven too slowly for the recipe: v times " +
                  std::to_string(v_factor) + ", w times " + std::to_string(w_factor));
  request.recipe = scaledRecipe(request.recipe, v_factor, w_factor);
  return true;
}

/// The sessions to compare, and a recipe that fits them.
SessionChoice chosenSessions(const std::vector<Session>& sessions, const std::string& robot,
                             DriveRequest& request, std::vector<std::string>& notes) {
  if (!request.sessions.empty()) {
    SessionChoice named = namedSessions(sessions, robot, request.sessions);
    const size_t surfaces = surfacesOf(named.taken).size();
    fitRecipe(request, commonReach(named.taken, robot, surfaces), notes);
    return named;
  }
  SessionChoice choice = comparableSessions(sessions, robot, request.recipe.reach());
  if (surfacesOf(choice.taken).size() >= request.min_surfaces) return choice;
  if (!fitRecipe(request, commonReach(sessions, robot, request.min_surfaces), notes)) return choice;
  return comparableSessions(sessions, robot, request.recipe.reach());
}

/// Throws one clear line if sessions of too few surfaces were chosen.
void requireSurfaces(const DriveRequest& request, const std::string& robot,
                     const std::vector<Session>& sessions, const SessionChoice& choice,
                     const std::vector<std::string>& notes) {
  const size_t needed = std::max<size_t>(1, request.min_surfaces);
  const std::vector<std::string> chosen = surfacesOf(choice.taken);
  if (chosen.size() >= needed) return;
  std::vector<Session> all;
  for (const Session& session : sessions)
    if (session.robot == robot) all.push_back(session);
  const std::vector<std::string> driven = surfacesOf(all);
  if (driven.size() == 1 && needed > 1)
    throw RecordingError(request.folder + ": " + robot + " was driven on one surface only ('" +
                         driven.front() + "'); learning from one to another needs two");
  throw RecordingError(request.folder + ": " + std::to_string(chosen.size()) + " surface(s) of " +
                       robot + " have comparable sessions" +
                       (chosen.empty() ? "" : " (" + joined(chosen) + ")") + ", " +
                       std::to_string(needed) + " are needed; " + joined(notes));
}

std::vector<SurfaceWindows> readSurfaces(const DriveRequest& request, const SessionChoice& choice) {
  std::vector<SurfaceWindows> surfaces;
  for (const std::string& name : surfacesOf(choice.taken)) {
    SurfaceWindows surface;
    surface.surface = name;
    for (const Session& session : choice.taken) {
      if (session.surface != name) continue;
      SessionWindows read =
          readWindows(request.folder, session, choice.baseline, request.recipe.length);
      surface.sessions.push_back(session.name);
      surface.used.insert(surface.used.end(), read.used.begin(), read.used.end());
      for (const auto& [reason, count] : read.left_out) surface.left_out[reason] += count;
    }
    surfaces.push_back(std::move(surface));
  }
  return surfaces;
}

/// Root mean square of the mean twist's deviations, per component.
Twist2 spreadOf(const LocalMotion& motion) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const TwistLine& deviation : motion.deviations)
    sum += deviation.vector().head<3>().cwiseAbs2();
  sum = (sum / static_cast<double>(motion.deviations.size())).cwiseSqrt();
  return {sum[0], sum[1], sum[2]};
}

std::string windowsLine(const SurfaceSummary& surface) {
  std::string text =
      formatted("%s: %zu steady windows used", surface.surface.c_str(), surface.windows);
  for (const auto& [reason, count] : surface.left_out)
    text += formatted(", %d left out: %s", count, reason.c_str());
  text += "\n  from";
  for (const std::string& session : surface.sessions) text += " " + session;
  return text + "\n";
}

std::string motionLine(const std::string& name, const LocalMotion& motion) {
  const Twist2& mean = motion.mean.mean;
  const Twist2 spread = spreadOf(motion);
  return formatted("  %-14s %7.3f %7.3f %7.3f   %6.3f %6.3f %6.3f   %7zu %6.2f %10zu %6zu\n",
                   name.c_str(), mean.v_x, mean.v_y, mean.omega, spread.v_x, spread.v_y,
                   spread.omega, motion.windows, motion.reach, 2 * motion.deviations.size(),
                   motion.implausible);
}

}  // namespace

std::string fileName(const std::string& surface) {
  std::string name;
  for (const char letter : surface) {
    const bool plain = std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '-';
    if (plain)
      name += letter;
    else if (!name.empty() && name.back() != '_')
      name += '_';
  }
  while (!name.empty() && name.back() == '_') name.pop_back();
  return name.empty() ? "surface" : name;
}

DriveRecordings recordingsOf(const std::vector<SurfaceWindows>& windows,
                             const PatternRecipe& recipe, double baseline, size_t min_surfaces) {
  std::vector<std::string> notes;
  std::vector<SurfaceSummary> surfaces;
  for (const SurfaceWindows& surface : windows) {
    try {
      surfaces.push_back(summarised(surface, recipe));
    } catch (const RecordingError& error) {
      notes.push_back("surface '" + surface.surface + "' left out: " + wordsOf(error));
    }
  }
  for (size_t i = 0; i < surfaces.size(); ++i)
    for (size_t j = 0; j < i; ++j)
      if (surfaces[i].surface == surfaces[j].surface)
        throw RecordingError("two surfaces would both be called '" + surfaces[i].surface +
                             "'; rename one in sessions.csv");
  if (surfaces.size() < std::max<size_t>(1, min_surfaces)) {
    std::string have;
    for (const SurfaceSummary& surface : surfaces) have += " '" + surface.surface + "'";
    throw RecordingError(std::to_string(surfaces.size()) + " comparable surface(s)" + have + ", " +
                         std::to_string(std::max<size_t>(1, min_surfaces)) + " are needed" +
                         (notes.empty() ? "" : " (" + joined(notes) + ")"));
  }
  PatternRecordings recordings{patternSet(surfaces, recipe, baseline), {}};
  for (const SurfaceSummary& surface : surfaces)
    recordings.surfaces.push_back(recordingsOf(surface, recipe));
  return {std::move(recordings), "", std::move(notes), std::move(surfaces)};
}

DriveRecordings recordingsFromDrives(const DriveRequest& asked) {
  DriveRequest request = asked;
  const std::vector<Session> sessions = readSessions(request.folder);
  const std::string robot = chooseRobot(sessions, request.robot);
  std::vector<std::string> notes;
  const SessionChoice choice = chosenSessions(sessions, robot, request, notes);
  for (const std::string& line : choice.left_out) notes.push_back("session left out: " + line);
  requireSurfaces(request, robot, sessions, choice, notes);
  DriveRecordings drives = recordingsOf(readSurfaces(request, choice), request.recipe,
                                        choice.baseline, request.min_surfaces);
  drives.robot = robot;
  drives.notes.insert(drives.notes.begin(), notes.begin(), notes.end());
  return drives;
}

PatternSet averagedSet(const DriveRecordings& drives, size_t surface) {
  std::vector<AverageNote> ignored;
  const PatternSet average = averageSet(
      drives.recordings.patterns, drives.recordings.surfaces.at(surface), AverageLimits{}, ignored);
  PatternSetContent content = average.content();
  content.name += " on " + drives.surfaces[surface].surface;
  for (size_t p = 0; p < content.classes.size(); ++p)
    content.classes[p].twist = rounded(drives.surfaces[surface].motions[p].mean.mean);
  std::string why;
  auto set = PatternSet::make(std::move(content), why);
  if (!set)
    throw RecordingError("the average of '" + drives.surfaces[surface].surface + "': " + why);
  return *set;
}

std::string reportOf(const DriveRecordings& drives) {
  std::string text = "robot: " + drives.robot + "\n";
  for (const std::string& note : drives.notes) text += note + "\n";
  const std::vector<MotionPattern>& patterns = drives.recordings.patterns.patterns();
  for (const SurfaceSummary& surface : drives.surfaces) {
    text += "\n" + windowsLine(surface);
    text +=
        formatted("  %-14s %23s   %20s   %7s %6s %10s %6s\n", "pattern", "v_x m/s, v_y m/s, w r/s",
                  "spread of executions", "windows", "reach", "recordings", "unfit");
    for (size_t p = 0; p < patterns.size(); ++p)
      text += motionLine(patterns[p].name, surface.motions[p]);
  }
  return text;
}

}  // namespace tread::recordings
