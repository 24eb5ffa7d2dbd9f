// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/experiment/crossings/crossings.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "common/config/scalars.hpp"
#include "common/recordings/csv_table.hpp"
#include "common/report/text.hpp"
#include "common/statistics/statistics.hpp"
#include "modules/learner/core/rules/make_rule.hpp"
#include "tools/lab/experiment/adaptation/tuning.hpp"
#include "tools/lab/experiment/end_region.hpp"
#include "tools/lab/experiment/rival_rule.hpp"

namespace tread::experiment {
namespace {

using import::CutPiece;
using recordings::CommandRun;
using recordings::kPeriod;
using recordings::RecordedDrive;
using recordings::RecordingError;
using recordings::TimedGround;

constexpr double kCompared = 2.0;       // [s] longest span compared before and after a change
constexpr double kLeastCompared = 0.5;  // [s] shortest span that shows whether it is real
constexpr double kRealChange = 0.1;     // [1] of the speed
constexpr double kSlowest = 0.01;       // [m/s] least speed at a border
constexpr double kSameTime = 1e-6;      // [s]

double lengthOf(const CutPiece& piece) {
  return kPeriod * static_cast<double>(piece.poses.size());
}

double endOf(const CutPiece& piece) {
  return piece.begin + lengthOf(piece);
}

/// The grounds in [begin, end), without those shorter than `shortest`.
std::vector<TimedGround> groundsWithin(const std::vector<TimedGround>& grounds, double begin,
                                       double end, double shortest) {
  std::vector<TimedGround> within;
  for (size_t i = 0; i < grounds.size(); ++i) {
    const double from = std::max(begin, grounds[i].time);
    const double to = i + 1 < grounds.size() ? std::min(end, grounds[i + 1].time) : end;
    if (to - from < shortest) continue;
    if (within.empty() || within.back().name != grounds[i].name)
      within.push_back({from, grounds[i].name});
  }
  return within;
}

/// Mean motion over a time span of consecutive pieces; nullopt if they do not cover it.
std::optional<Twist2> twistOver(const std::vector<CutPiece>& pieces, double begin, double end) {
  Pose2 moved;
  double covered = 0.0;
  for (const CutPiece& piece : pieces) {
    Pose2 before;
    for (size_t i = 0; i < piece.poses.size(); ++i) {
      const double time = piece.begin + kPeriod * static_cast<double>(i);
      const Pose2 step = between(before, piece.poses[i]);
      before = piece.poses[i];
      if (time < begin - kSameTime || time + kPeriod > end + kSameTime) continue;
      moved = moved * step;
      covered += kPeriod;
    }
  }
  if (covered < kLeastCompared) return std::nullopt;
  return twistTo(moved, covered);
}

/// Marks the changes after which the motion differs.
void findReal(CrossingRun& run, double border) {
  for (size_t i = 0; i < run.changes.size(); ++i) {
    const double time = run.changes[i].time;
    const double begin = std::max(time - kCompared, i > 0 ? run.changes[i - 1].time : 0.0);
    const double end = std::min(
        time + kCompared, i + 1 < run.changes.size() ? run.changes[i + 1].time : time + kCompared);
    const auto before = twistOver(run.pieces, begin, time);
    const auto after = twistOver(run.pieces, time, end);
    run.changes[i].real = before && after &&
                          std::hypot(after->v_x - before->v_x, after->v_y - before->v_y) >
                              kRealChange * std::hypot(before->v_x, before->v_y);
    if (before)
      run.changes[i].early = border / std::max(kSlowest, std::hypot(before->v_x, before->v_y));
  }
}

/// Runs of consecutive pieces under one command.
std::vector<std::vector<CutPiece>> inRuns(const std::vector<CutPiece>& pieces) {
  std::vector<std::vector<CutPiece>> runs;
  for (const CutPiece& piece : pieces) {
    const bool follows = !runs.empty() && runs.back().back().run == piece.run &&
                         std::abs(endOf(runs.back().back()) - piece.begin) < kSameTime;
    if (!follows) runs.emplace_back();
    runs.back().push_back(piece);
  }
  return runs;
}

/// Drops the part before the first `known` pieces without a change; everything if there are none.
void beginKnown(CrossingRun& run, size_t known) {
  for (size_t first = 0; first + known < run.pieces.size(); ++first) {
    const double begin = run.pieces[first].begin;
    const double end = endOf(run.pieces[first + known - 1]);
    const bool calm = std::none_of(run.changes.begin(), run.changes.end(), [&](const auto& change) {
      return change.time > begin && change.time < end;
    });
    if (!calm) continue;
    run.pieces.erase(run.pieces.begin(), run.pieces.begin() + static_cast<std::ptrdiff_t>(first));
    run.changes.erase(std::remove_if(run.changes.begin(), run.changes.end(),
                                     [&](const auto& change) { return change.time <= begin; }),
                      run.changes.end());
    return;
  }
  run.pieces.clear();
}

/// Scatter of pieces of unchanged ground around their run's mean: medians, because poses may jump.
struct Scatter {
  /// standard deviation of an end's x and y [m], relative to the size of the command
  double position = 0.0;
  double yaw = 0.0;  ///< [rad]
};

/// Slippery ground scatters more per metre driven, so the scale is the command.
double sizeOf(const Command& command) {
  double sum = 0.0;
  for (size_t c = 0; c < Command::kMaxChannels; ++c) sum += command[c] * command[c];
  return std::sqrt(sum);
}

/// The variance for which sums of squares of normal numbers have this median.
double varianceOf(std::vector<double> sums, double freedom) {
  return upperMedian(std::move(sums)) /
         (freedom * std::pow(1.0 - 2.0 / (9.0 * freedom), 3.0));  // Wilson, Hilferty
}

Pose2 meanEnd(const CrossingRun& run, size_t known) {
  Pose2 sum;
  const auto n = static_cast<double>(known);
  for (size_t i = 0; i < known; ++i) {
    const Pose2& end = run.pieces[i].poses.back();
    sum = {sum.x + end.x / n, sum.y + end.y / n, sum.yaw + end.yaw / n};
  }
  return sum;
}

Scatter scatterOf(const std::vector<CrossingDrives>& drives, size_t known) {
  std::vector<double> positions, yaws;
  for (const CrossingDrives& drive : drives)
    for (const CrossingRun& run : drive.runs) {
      const Pose2 mean = meanEnd(run, known);
      const double size = sizeOf(run.pieces[0].command);
      double position = 0.0, yaw = 0.0;
      for (size_t i = 0; i < known; ++i) {
        const Pose2& end = run.pieces[i].poses.back();
        position += (end.position() - mean.position()).squaredNorm() / (size * size);
        yaw += std::pow(end.yaw - mean.yaw, 2.0);
      }
      positions.push_back(position);
      yaws.push_back(yaw);
    }
  if (positions.empty())
    throw RecordingError(
        "no run is left: commands must last for --offset and more than --known pieces (--cut) of "
        "unchanged ground");
  const auto freedom = static_cast<double>(known - 1);
  return {std::sqrt(varianceOf(positions, 2.0 * freedom)), std::sqrt(varianceOf(yaws, freedom))};
}

/// Initial set of a run: its known pieces, averaged, with the scatter of pieces.
PatternSet setOf(const CrossingRun& run, const CommandChannels& channels, const Scatter& scatter,
                 size_t known) {
  MotionPattern pattern;
  pattern.id = 1;
  pattern.name = pattern.entry_class = pattern.exit_class = "run";
  pattern.commands.assign(run.pieces[0].poses.size(), run.pieces[0].command);
  pattern.trajectory.assign(run.pieces[0].poses.size(), {});
  const auto n = static_cast<double>(known);
  for (size_t i = 0; i < known; ++i)
    for (size_t t = 0; t < pattern.trajectory.size(); ++t) {
      Pose2& mean = pattern.trajectory[t];
      const Pose2& pose = run.pieces[i].poses[t];
      mean = {mean.x + pose.x / n, mean.y + pose.y / n, mean.yaw + pose.yaw / n};
    }
  const double position = scatter.position * sizeOf(pattern.commands[0]);
  pattern.end_covariance = {position * position, 0.0, 0.0,
                            position * position, 0.0, scatter.yaw * scatter.yaw};
  PatternSetContent content;
  content.name = "run";
  content.channels = channels;
  content.period_us = std::llround(kPeriod * 1e6);
  content.classes = {
      {"run", twistTo(pattern.end(), lengthOf(run.pieces[0])), run.pieces[0].command}};
  content.patterns = {std::move(pattern)};
  std::string why;
  auto set = PatternSet::make(std::move(content), why);
  if (!set) throw RecordingError("a run makes no pattern: " + why);
  return *set;
}

std::unique_ptr<learner::LearningRule> ruleNamed(const std::string& name, const PatternSet& set,
                                                 const CrossingSettings& settings) {
  const auto& rivals = adaptation::rivalNames();
  if (std::find(rivals.begin(), rivals.end(), name) == rivals.end()) {
    learner::RuleConfig config = settings.config;
    config.rule = name;
    return learner::makeRule(config, set);
  }
  const MotionPattern& pattern = set.patterns()[0];
  const double seconds = set.periodSeconds() * static_cast<double>(pattern.commands.size());
  const PoseCovariance& P = pattern.end_covariance;
  const Eigen::Vector3d noise = Eigen::Vector3d(P[0], P[3], P[5]) / (seconds * seconds);
  constexpr uint64_t kFeatureSeed = 1;
  return std::make_unique<RivalRule>(adaptation::tunedRival(name, {}, kFeatureSeed), set,
                                     std::vector<Eigen::Vector3d>{noise.cwiseMax(1e-8)});
}

/// One rule on one run.
class CrossingDrive {
 public:
  CrossingDrive(const CrossingRun& run, const PatternSet& set, const CrossingSettings& settings,
                CrossingErrors& errors)
      : run_(run),
        set_(set),
        settings_(settings),
        errors_(errors),
        rule_(ruleNamed(errors.rule, set, settings)),
        watch_(settings.test) {
    numbers_.resize(3 * run.pieces[0].poses.size());
  }

  void drive() {
    for (size_t i = settings_.known; i < run_.pieces.size(); ++i) {
      score(run_.pieces[i]);
      learn(run_.pieces[i]);
    }
    Notices& notices = errors_.notices;
    if (!tested_) return;
    ++notices.runs;
    if (false_alarm_) ++notices.false_runs;
    for (const GroundChange& change : run_.changes)
      if (change.real) noteDelay(change);
  }

 private:
  /// Last change of ground before a time; nullopt if there was none.
  const GroundChange* changeBefore(double time) const {
    const GroundChange* last = nullptr;
    for (const GroundChange& change : run_.changes)
      if (change.time < time - kSameTime) last = &change;
    return last;
  }

  /// Whether the ground may have changed before a time, given the uncertainty of borders.
  bool mayHaveChanged(double time) const {
    return std::any_of(run_.changes.begin(), run_.changes.end(), [&](const GroundChange& change) {
      return change.time - change.early < time - kSameTime;
    });
  }

  Phase phaseOf(const CutPiece& piece) const {
    const GroundChange* const change = changeBefore(endOf(piece));
    if (change == nullptr) return Phase::kBefore;
    const double since = endOf(piece) - change->time;
    const auto pieces = static_cast<size_t>(std::ceil(since / lengthOf(piece) - kSameTime));
    return static_cast<Phase>(std::min(pieces, static_cast<size_t>(Phase::kLater)));
  }

  std::optional<PoseCovariance> covariance() const {
    if (errors_.rule != "off") return rule_->endCovariance(0);
    // The mean of the known pieces has an error, too.
    PoseCovariance of_one = set_.patterns()[0].end_covariance;
    for (double& entry : of_one) entry *= 1.0 + 1.0 / static_cast<double>(settings_.known);
    return of_one;
  }

  void score(const CutPiece& piece) {
    const Pose2 predicted = rule_->predictEnd(0);
    const Pose2& end = piece.poses.back();
    PhaseErrors& phase = errors_.phases[static_cast<size_t>(phaseOf(piece))];
    ++phase.pieces;
    phase.metres += lengthOfPath(piece.poses);
    phase.position += (end.position() - predicted.position()).norm();
    const auto stated = covariance();
    if (!stated) return;
    ++phase.regions;
    if (isInside(predicted, end, *stated)) ++phase.inside;
  }

  /// Watches the running piece, then learns from it.
  void learn(const CutPiece& piece) {
    learner::fill(piece.poses, numbers_);
    const auto samples = static_cast<Eigen::Index>(piece.poses.size());
    const learner::ConstTrajectory measured(numbers_.data(), samples, 3);
    const bool tested = rule_->departure(0, measured, 0, samples).has_value();
    const auto change = watch_.notice(*rule_, 0, measured, kPeriod);
    if (tested) noteTested(piece, change);
    Context context;
    if (change) context.changed_after = change->after;
    rule_->setContext(context);
    watch_.clear();
    if (!change) watch_.follow(*rule_, 0, measured, kPeriod);
    learner::RuleNote note;
    rule_->learn(0, measured, note);
  }

  void noteTested(const CutPiece& piece, const std::optional<learner::NoticedChange>& change) {
    tested_ = true;
    if (!mayHaveChanged(endOf(piece))) errors_.notices.undisturbed += lengthOf(piece);
    if (!change) return;
    const double time = piece.begin + kPeriod * static_cast<double>(change->noticed);
    alarms_.push_back(time);
    false_alarm_ = false_alarm_ || !mayHaveChanged(time);
  }

  void noteDelay(const GroundChange& change) {
    const double tested_until = endOf(run_.pieces.back());
    if (change.time + settings_.test.window > tested_until) return;
    ++errors_.notices.real;
    for (const double alarm : alarms_)
      if (alarm > change.time - change.early && alarm - change.time < Notices::kLatest) {
        errors_.notices.delays.push_back(std::max(0.0, alarm - change.time));
        return;
      }
  }

  const CrossingRun& run_;
  const PatternSet& set_;
  const CrossingSettings& settings_;
  CrossingErrors& errors_;
  std::unique_ptr<learner::LearningRule> rule_;
  learner::ChangeWatch watch_;
  std::vector<double> numbers_;
  bool tested_ = false;
  bool false_alarm_ = false;
  std::vector<double> alarms_;  ///< [s]
};

}  // namespace

const std::array<const char*, kPhases> kPhaseNames{"before", "changing", "second", "third",
                                                   "later"};

size_t Notices::within(double seconds) const {
  return static_cast<size_t>(std::count_if(
      delays.begin(), delays.end(), [&](double delay) { return delay <= seconds + kSameTime; }));
}

CrossingDrives crossingRuns(const RecordedDrive& drive, const CrossingSettings& settings) {
  import::CutSurface surface;
  import::cutDrive(drive, settings.cut, surface);
  CrossingDrives result;
  result.channels = drive.channels;
  size_t none = 0;
  for (std::vector<CutPiece>& pieces : inRuns(surface.pieces)) {
    CrossingRun run;
    const std::vector<TimedGround> grounds =
        groundsWithin(drive.grounds, pieces.front().begin, endOf(pieces.back()), settings.shortest);
    for (size_t i = 1; i < grounds.size(); ++i)
      run.changes.push_back({grounds[i].time, grounds[i - 1].name, grounds[i].name, false});
    run.pieces = std::move(pieces);
    findReal(run, settings.border);
    beginKnown(run, settings.known);
    if (run.pieces.empty())
      ++none;
    else
      result.runs.push_back(std::move(run));
  }
  for (const auto& [why, part] : surface.left_out)
    result.notes.push_back("left out " + formatted("%.1f", part.seconds) + " s (" +
                           std::to_string(part.count) + " times) " + why);
  if (none > 0)
    result.notes.push_back("left out " + std::to_string(none) + " runs that have no " +
                           std::to_string(settings.known) +
                           " pieces without a change and one after them");
  return result;
}

std::vector<CrossingErrors> driveCrossings(const std::vector<CrossingDrives>& drives,
                                           const CrossingSettings& settings) {
  const std::vector<std::string> known = learnerNames();
  for (const std::string& rule : settings.rules)
    if (std::find(known.begin(), known.end(), rule) == known.end())
      throw std::invalid_argument("--rules: unknown rule '" + rule + "'; known are " +
                                  joinWords(known));
  std::vector<CrossingErrors> all;
  const Scatter scatter = scatterOf(drives, settings.known);
  for (const std::string& rule : settings.rules) {
    CrossingErrors errors;
    errors.rule = rule;
    for (const CrossingDrives& drive : drives)
      for (const CrossingRun& run : drive.runs) {
        const PatternSet set = setOf(run, drive.channels, scatter, settings.known);
        CrossingDrive(run, set, settings, errors).drive();
      }
    all.push_back(std::move(errors));
  }
  return all;
}

}  // namespace tread::experiment
