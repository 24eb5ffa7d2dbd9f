// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors

#include "tools/lab/replay/learner_report.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <sstream>

#include "common/report/plot.hpp"
#include "common/report/text.hpp"
#include "common/statistics/statistics.hpp"

namespace tread::replay {
namespace {

/// Executions in the running mean of the curves.
constexpr size_t kRunning = 15;

constexpr double kDegrees = 180.0 / kPi;

using report::Panel;
using report::Picture;
using Belongs = std::function<bool(const learning_t&)>;

std::vector<learning_t> filtered(const std::vector<learning_t>& learned, const Belongs& belongs) {
  std::vector<learning_t> result;
  std::copy_if(learned.begin(), learned.end(), std::back_inserter(result), belongs);
  return result;
}

/// Measured, and scored against the set named in its record.
bool isScored(const learning_t& learned) {
  return learned.accepted && std::isfinite(learned.error_position);
}

Belongs isOfClass(const PatternSet& set, const std::string& name) {
  return [&set, name](const learning_t& learned) {
    const MotionPattern* pattern = set.find(learned.learned_pattern_id);
    return pattern != nullptr && commandClass(*pattern, set.content().channels) == name;
  };
}

/// One group of executions, a line per run.
void writeGroup(std::ostream& out, const std::string& name, const std::vector<LearnerRun>& runs,
                const Belongs& belongs) {
  bool first = true;
  for (const LearnerRun& run : runs) {
    const ErrorSummary errors = summarise(filtered(run.learned, belongs));
    if (errors.count == 0) return;
    const std::string count = first ? formatted("%4zu", errors.count) : "    ";
    out << formatted("  %-22s %s  %-22s %7.3f %7.3f   %7.2f %7.2f\n", first ? name.c_str() : "",
                     count.c_str(), run.title.c_str(), errors.position_mean, errors.position_median,
                     errors.yaw_mean * kDegrees, errors.yaw_median * kDegrees);
    first = false;
  }
}

void writeHead(std::ostream& out, const std::string& what) {
  out << "\nprediction error at the end of each execution, by " << what << "\n"
      << formatted("  %-22s %4s  %-22s %15s   %15s\n", "", "n", "", "position [m]", "|yaw| [deg]")
      << formatted("  %-22s %4s  %-22s %7s %7s   %7s %7s\n", "", "", "", "mean", "median", "mean",
                   "median");
}

void writeIntake(std::ostream& out, const DriveLog& log, const LearnerRun& run) {
  const auto accepted = std::count_if(run.learned.begin(), run.learned.end(),
                                      [](const learning_t& l) { return l.accepted; });
  const size_t scored = summarise(run.learned).count;
  out << log.name << ": " << log.executions.size() << " executions in, " << accepted
      << " measured, " << (static_cast<int64_t>(run.learned.size()) - accepted) << " refused\n";
  for (const auto& [name, count] : run.counters)
    if (name.rfind("refused: ", 0) == 0) out << formatted("  %5ld %s\n", long{count}, name.c_str());
  if (static_cast<int64_t>(scored) != accepted)
    out << "  of the measured ones " << scored
        << " have a measured end; only those are in the errors below\n";
  if (run.learned.size() != log.executions.size())
    out << "  " << log.executions.size() - run.learned.size() << " before the first INS message\n";
  if (!log.problem.empty()) out << "  " << log.problem << "\n";
  if (!run.health.empty()) out << "  HEALTH at the end: " << run.health << "\n";
}

/// Counts of the guards that limited corrections.
void writeGuards(std::ostream& out, const LearnerRun& run) {
  std::map<std::string, int> guards;
  for (const learning_t& learned : run.learned) {
    if (!learned.accepted) continue;
    std::istringstream parts(learned.gate_reason);
    for (std::string guard; std::getline(parts, guard, ';');)
      ++guards[guard.substr(guard.find_first_not_of(' '))];
  }
  if (guards.empty()) return;
  out << "\nguards of '" << run.title << "'\n";
  for (const auto& [guard, count] : guards) out << formatted("  %5d %s\n", count, guard.c_str());
}

/// Measured driving and turning relative to the initial set of the learner.
std::string groundLine(const std::vector<learning_t>& learned) {
  double way = 0.0, predicted_way = 0.0, turn = 0.0, predicted_turn = 0.0;
  for (const learning_t& one : learned) {
    if (!isScored(one)) continue;
    way += std::hypot(one.measured_end[0], one.measured_end[1]);
    predicted_way += std::hypot(one.predicted_end[0], one.predicted_end[1]);
    // Opposite to the prediction's direction.
    turn += one.predicted_end[2] < 0.0 ? -one.measured_end[2] : one.measured_end[2];
    predicted_turn += std::abs(one.predicted_end[2]);
  }
  if (predicted_way <= 0.0 || predicted_turn <= 0.0) return "";
  return formatted(
      "On this ground the vehicle drove %.0f %% as far and turned %.0f %% as much as the initial "
      "set predicts.\n",
      100.0 * way / predicted_way, 100.0 * turn / predicted_turn);
}

/// The result in one line.
std::string resultLine(const DriveLog& log, const std::vector<LearnerRun>& runs) {
  std::string result = log.name + ": mean prediction error of " +
                       std::to_string(summarise(runs.front().learned).count) + " executions: ";
  for (const LearnerRun& run : runs) {
    const ErrorSummary errors = summarise(run.learned);
    result += formatted("%s%s %.3f m %.1f deg", &run == &runs.front() ? "" : "; ",
                        run.title.c_str(), errors.position_mean, errors.yaw_mean * kDegrees);
  }
  return result + "\n";
}

/// Number of executions that a run predicted better than the first run did.
void writeComparison(std::ostream& out, const std::vector<LearnerRun>& runs) {
  const std::vector<learning_t>& base = runs.front().learned;
  for (size_t r = 1; r < runs.size(); ++r) {
    size_t position = 0;
    size_t yaw = 0;
    size_t all = 0;
    for (size_t i = 0; i < std::min(base.size(), runs[r].learned.size()); ++i) {
      const learning_t& other = runs[r].learned[i];
      if (!std::isfinite(base[i].error_position) || !std::isfinite(other.error_position)) continue;
      ++all;
      position += other.error_position < base[i].error_position ? 1 : 0;
      yaw += std::abs(other.error_yaw) < std::abs(base[i].error_yaw) ? 1 : 0;
    }
    out << formatted(
        "  '%s' predicts better than '%s' in %zu of %zu positions and %zu of %zu yaws\n",
        runs[r].title.c_str(), runs.front().title.c_str(), position, all, yaw, all);
  }
}

/// Quantity of a part of the picture: position [m] or yaw [deg].
struct ErrorKind {
  std::string label;
  double (*of)(const learning_t&);
  double (*mean)(const ErrorSummary&);
};

const ErrorKind kPosition{"position error [m]",
                          [](const learning_t& one) { return one.error_position; },
                          [](const ErrorSummary& errors) { return errors.position_mean; }};
const ErrorKind kYaw{"yaw error [deg]",
                     [](const learning_t& one) { return std::abs(one.error_yaw) * kDegrees; },
                     [](const ErrorSummary& errors) { return errors.yaw_mean * kDegrees; }};

std::vector<Eigen::Vector2d> runningMean(const std::vector<learning_t>& learned,
                                         const ErrorKind& error) {
  std::vector<Eigen::Vector2d> points;
  std::vector<double> values;
  for (const learning_t& one : learned) {
    if (!isScored(one)) continue;
    values.push_back(error.of(one));
    const size_t from = values.size() > kRunning ? values.size() - kRunning : 0;
    double sum = 0.0;
    for (size_t i = from; i < values.size(); ++i) sum += values[i];
    points.emplace_back(static_cast<double>(values.size()),
                        sum / static_cast<double>(values.size() - from));
  }
  return points;
}

void drawCurves(Picture& canvas, const report::Box& box, const std::vector<LearnerRun>& runs,
                const ErrorKind& error) {
  double highest = 0.0;
  double longest = 2.0;
  for (const LearnerRun& run : runs)
    for (const auto& point : runningMean(run.learned, error)) {
      highest = std::max(highest, point.y());
      longest = std::max(longest, point.x());
    }
  Panel::Axes axes;
  axes.title = "running mean of " + std::to_string(kRunning) + " executions";
  axes.x_label = "execution";
  axes.y_label = error.label;
  axes.x_min = 1.0;
  axes.x_max = longest;
  axes.y_max = highest > 0.0 ? 1.1 * highest : 1.0;
  Panel panel(canvas, box, axes);
  for (size_t r = 0; r < runs.size(); ++r) {
    report::Style style;
    style.colour = r == 0 ? report::kGrey : report::seriesColour(r - 1);
    style.width = 2.0;
    style.label = runs[r].title;
    panel.line(runningMean(runs[r].learned, error), style);
  }
  panel.finish();
}

void drawBars(Picture& canvas, const report::Box& box, const PatternSet& set,
              const std::vector<LearnerRun>& runs, const ErrorKind& error) {
  std::set<std::string> known;
  for (const learning_t& one : runs.front().learned)
    if (const MotionPattern* pattern = set.find(one.learned_pattern_id))
      if (one.accepted) known.insert(commandClass(*pattern, set.content().channels));
  const std::vector<std::string> names(known.begin(), known.end());
  const auto meanOf = [&](const LearnerRun& run, const std::string& name) {
    return error.mean(summarise(filtered(run.learned, isOfClass(set, name))));
  };
  double highest = 0.0;
  for (const std::string& name : names)
    for (const LearnerRun& run : runs) highest = std::max(highest, meanOf(run, name));
  Panel::Axes axes;
  axes.title = "mean by command";
  axes.y_label = error.label;
  axes.x_min = -0.6;
  axes.x_max = std::max(1.0, static_cast<double>(names.size())) - 0.4;
  axes.y_max = highest > 0.0 ? 1.1 * highest : 1.0;
  Panel panel(canvas, box, axes);
  panel.xNames(names);
  const double width = 0.8 / static_cast<double>(runs.size());
  for (size_t n = 0; n < names.size(); ++n)
    for (size_t r = 0; r < runs.size(); ++r) {
      const double at = static_cast<double>(n) - 0.4 + (static_cast<double>(r) + 0.5) * width;
      panel.bar(at, meanOf(runs[r], names[n]), 0.9 * width,
                r == 0 ? report::kGrey : report::seriesColour(r - 1));
    }
  panel.finish();
}

}  // namespace

ErrorSummary summarise(const std::vector<learning_t>& learned) {
  std::vector<double> position;
  std::vector<double> yaw;
  for (const learning_t& one : learned) {
    if (!isScored(one)) continue;
    position.push_back(one.error_position);
    yaw.push_back(std::abs(one.error_yaw));
  }
  return {position.size(), meanOf(position, 0.0), medianOf(position, 0.0), meanOf(yaw, 0.0),
          medianOf(yaw, 0.0)};
}

namespace {

std::string steeredClass(const MotionPattern& pattern, const CommandChannels& channels) {
  double drive = 0.0, steering = 0.0;
  for (const Command& command : pattern.commands)
    for (size_t i = 0; i < channels.size(); ++i) {
      const bool steers = channels[i].kind == CommandKind::kSteeringAngle;
      (steers ? steering : drive) += steers ? std::abs(command[i]) : command[i];
    }
  const double little = 0.02 * static_cast<double>(pattern.commands.size());
  if (std::abs(drive) < little) return "standing";
  return std::string(drive > 0.0 ? "forward" : "reverse") + (steering > little ? " turn" : "");
}

/// For a holonomic base, whose commands mean little without the wheels' positions: the direction of
/// motion.
std::string directionClass(const MotionPattern& pattern) {
  const Pose2& end = pattern.end();
  const double way = pattern.pathLength(), turned = std::abs(end.yaw);
  if (way < 0.02 && turned < 0.02) return "standing";
  if (way < 0.2 * turned) return "turning on the spot";
  const bool aside = std::abs(end.y) > std::abs(end.x);
  return std::string(aside         ? "sideways"
                     : end.x > 0.0 ? "forward"
                                   : "reverse") +
         (turned > 0.1 ? " turn" : "");
}

}  // namespace

std::string commandClass(const MotionPattern& pattern, const CommandChannels& channels) {
  if (channels.size() > 2) return directionClass(pattern);
  if (!kindOfTracks(channels)) return steeredClass(pattern, channels);
  double left = 0.0;
  double right = 0.0;
  for (const Command& command : pattern.commands) {
    left += command[0];
    right += command[1];
  }
  const double sum = std::abs(left) + std::abs(right);
  if (sum < 0.02 * static_cast<double>(pattern.commands.size())) return "standing";
  if (left * right < 0.0) return "counter-rotating";
  const std::string direction = left + right > 0.0 ? "forward" : "reverse";
  return std::abs(right - left) <= 0.1 * sum ? direction : direction + " turn";
}

std::string reportOf(const DriveLog& log, const PatternSet& set,
                     const std::vector<LearnerRun>& runs) {
  std::ostringstream out;
  writeIntake(out, log, runs.front());
  writeHead(out, "surface");
  std::set<std::string> surfaces;
  for (const learning_t& learned : runs.front().learned)
    surfaces.insert(log.surfaceAt(learned.utime));
  for (const std::string& surface : surfaces)
    writeGroup(out, surface, runs,
               [&](const learning_t& l) { return log.surfaceAt(l.utime) == surface; });
  writeHead(out, "command");
  for (const std::string name :
       {"forward", "forward turn", "counter-rotating", "reverse turn", "reverse", "standing"})
    writeGroup(out, name, runs, isOfClass(set, name));
  out << "\n";
  writeComparison(out, runs);
  if (runs.size() > 1) writeGuards(out, runs.back());
  out << "\n" << groundLine(runs.front().learned) << resultLine(log, runs);
  return out.str();
}

void drawReport(const DriveLog& log, const PatternSet& set, const std::vector<LearnerRun>& runs,
                const std::string& path) {
  Picture canvas(1200, 800, log.name + ": error of predicted ends of executions");
  drawCurves(canvas, {70, 60, 500, 310}, runs, kPosition);
  drawCurves(canvas, {660, 60, 500, 310}, runs, kYaw);
  drawBars(canvas, {70, 440, 500, 300}, set, runs, kPosition);
  drawBars(canvas, {660, 440, 500, 300}, set, runs, kYaw);
  canvas.save(path);
}

}  // namespace tread::replay
