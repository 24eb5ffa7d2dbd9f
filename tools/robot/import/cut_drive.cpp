// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/import/cut_drive.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <Eigen/QR>

#include "common/geometry/track.hpp"
#include "common/recordings/drive_recordings.hpp"
#include "common/report/text.hpp"
#include "tools/robot/import/foreign_drive.hpp"

namespace tread::import {
namespace {

using recordings::CommandRun;
using recordings::DriveSample;
using recordings::Execution;
using recordings::kMaxInterpolated;
using recordings::kPeriod;
using recordings::RecordedDrive;
using recordings::RecordingError;

constexpr double kSameInstant = 1e-6;  // [s]
// [s] added, because a track has no negative times and a fix may be early
constexpr double kTrackOrigin = 100.0;
// [1] of the largest command: rounding noise within one command
constexpr double kSameCommand = 1e-4;

int64_t trackTime(double seconds) {
  return std::llround((seconds + kTrackOrigin) * 1e6);
}

/// Rounded to micrometres or microradians, to keep files readable.
double inMicro(double value) {
  return std::round(value * 1e6) / 1e6 + 0.0;
}

/// Cuts one drive.
class Cutter {
 public:
  Cutter(const RecordedDrive& drive, const CutLayout& layout, CutSurface& surface)
      : drive_(drive),
        layout_(layout),
        surface_(surface),
        samples_(static_cast<size_t>(std::lround(layout.length / kPeriod))) {
    for (const recordings::Fix& fix : drive.fixes)
      history_.push(trackTime(fix.time), fix.T_map_body, {}, fix.new_track);
  }

  void cut() {
    for (; run_ < drive_.runs.size(); ++run_) cutRun(drive_.runs[run_]);
  }

 private:
  void leaveOut(const std::string& why, double seconds) {
    UncutPart& part = surface_.left_out[why];
    ++part.count;
    part.seconds += seconds;
  }

  void cutRun(const CommandRun& run) {
    const double lasts = run.end - run.begin;
    surface_.seconds += lasts;
    const double steady = lasts - layout_.settle;
    if (steady < layout_.length - kSameInstant)
      return leaveOut("of commands shorter than a piece", lasts);
    if (layout_.settle > 0.0) leaveOut("after a change of command", layout_.settle);
    const auto pieces = static_cast<size_t>(std::floor(steady / layout_.length + kSameInstant));
    for (size_t i = 0; i < pieces; ++i)
      cutPiece(run.begin + layout_.settle + static_cast<double>(i) * layout_.length);
    const double rest = steady - static_cast<double>(pieces) * layout_.length;
    if (rest > kSameInstant) leaveOut("at the end of a command, shorter than a piece", rest);
  }

  void cutPiece(double begin) {
    const std::string problem = commandProblem(begin);
    if (!problem.empty()) return leaveOut(problem, layout_.length);
    CutPiece piece{sampleAt(begin)->command, {}, begin, run_};
    const PoseTrack* const track = history_.covering(trackTime(begin));
    const auto at = [&](double time) -> std::optional<Pose2> {
      if (track == nullptr) return std::nullopt;
      return track->at(trackTime(time), std::llround(kMaxInterpolated * 1e6));
    };
    const std::optional<Pose2> T_map_begin = at(begin);
    for (size_t i = 1; i <= samples_ && T_map_begin; ++i) {
      const auto T_map_body = at(begin + static_cast<double>(i) * kPeriod);
      if (!T_map_body) break;
      piece.poses.push_back(between(*T_map_begin, *T_map_body));
    }
    if (piece.poses.size() < samples_)
      return leaveOut("with poses missing, jumping, or more than 0.3 s apart", layout_.length);
    surface_.pieces.push_back(std::move(piece));
  }

  /// The newest sample at a time.
  std::vector<DriveSample>::const_iterator sampleAt(double time) const {
    const auto after = std::upper_bound(
        drive_.drive.begin(), drive_.drive.end(), time + kSameInstant,
        [](double instant, const DriveSample& sample) { return instant < sample.time; });
    return after == drive_.drive.begin() ? drive_.drive.end() : std::prev(after);
  }

  /// Why a piece has no constant command; empty if it has.
  std::string commandProblem(double begin) const {
    const double end = begin + layout_.length - kPeriod / 2.0;
    const auto first = sampleAt(begin);
    if (first == drive_.drive.end()) return "with commands that are missing";
    double last = first->time;
    for (auto sample = first; sample != drive_.drive.end() && sample->time < end; ++sample) {
      if (!sample->automatic) return "driven by the operator";
      if (sample->command != first->command) return "in which the command changes";
      if (sample->time - last > recordings::kLongestHold + kSameInstant)
        return "with commands that are missing";
      last = sample->time;
    }
    return begin + layout_.length - last > recordings::kLongestHold + kSameInstant
               ? "with commands that are missing"
               : "";
  }

  const RecordedDrive& drive_;
  const CutLayout& layout_;
  CutSurface& surface_;
  size_t samples_;
  size_t run_ = 0;  ///< index of the current run
  TrackHistory history_{INT64_MAX / 2};
};

Twist2 meanTwist(const Execution& poses) {
  return twistTo(poses.back(), kPeriod * static_cast<double>(poses.size()));
}

Eigen::Vector3d vectorOf(const Twist2& twist) {
  return {twist.v_x, twist.v_y, twist.omega};
}

/// Largest difference of two commands over the channels [1], relative to each channel's largest
/// command.
double difference(const Command& a, const Command& b, const Command& largest) {
  double most = 0.0;
  for (size_t c = 0; c < Command::kMaxChannels; ++c)
    if (largest[c] > 0.0) most = std::max(most, std::abs(a[c] - b[c]) / largest[c]);
  return most;
}

/// The largest command of each channel, over all channels of its kind.
Command largestOf(const std::vector<CutSurface>& surfaces) {
  std::map<CommandKind, double> of_kind;
  const CommandChannels& channels = surfaces.front().channels;
  for (const CutSurface& surface : surfaces)
    for (const CutPiece& piece : surface.pieces)
      for (size_t c = 0; c < channels.size(); ++c) {
        double& most = of_kind[channels[c].kind];
        most = std::max(most, std::abs(piece.command[c]));
      }
  Command largest;
  for (size_t c = 0; c < channels.size(); ++c) largest[c] = of_kind[channels[c].kind];
  return largest;
}

/// B of twist = B u on a surface (3 x channels).
Eigen::MatrixXd twistOfCommands(const CutSurface& surface) {
  const auto channels = static_cast<Eigen::Index>(surface.channels.size());
  const auto pieces = static_cast<Eigen::Index>(surface.pieces.size());
  Eigen::MatrixXd commands(pieces, channels), twists(pieces, 3);
  for (Eigen::Index i = 0; i < pieces; ++i) {
    const CutPiece& piece = surface.pieces[static_cast<size_t>(i)];
    for (Eigen::Index c = 0; c < channels; ++c)
      commands(i, c) = piece.command[static_cast<size_t>(c)];
    twists.row(i) = vectorOf(meanTwist(piece.poses)).transpose();
  }
  return commands.completeOrthogonalDecomposition().solve(twists).transpose();
}

/// A piece corrected to another command: B times the difference of the commands is added to its
/// twists.
Execution corrected(const CutPiece& piece, const Command& wanted, const Eigen::MatrixXd& B) {
  Eigen::VectorXd change(B.cols());
  for (Eigen::Index c = 0; c < B.cols(); ++c)
    change[c] = wanted[static_cast<size_t>(c)] - piece.command[static_cast<size_t>(c)];
  const Eigen::Vector3d more = B * change;
  Execution poses;
  Pose2 before, T_start_body;
  for (const Pose2& pose : piece.poses) {
    const Twist2 twist = twistTo(between(before, pose), kPeriod);
    T_start_body =
        T_start_body *
        integrate({twist.v_x + more.x(), twist.v_y + more.y(), twist.omega + more.z()}, kPeriod);
    poses.push_back(T_start_body);
    before = pose;
  }
  return poses;
}

/// Groups pieces into patterns.
class PatternMaker {
 public:
  PatternMaker(const std::vector<CutSurface>& surfaces, const CutLayout& layout,
               const std::optional<PatternSet>& known)
      : surfaces_(surfaces), layout_(layout), known_(known), largest_(largestOf(surfaces)) {}

  CutRecordings make() {
    findCommands();
    for (const CutSurface& surface : surfaces_) sort(surface);
    if (!known_) keepCommon();
    CutRecordings result{{known_ ? *known_ : newSet(), {}}, std::move(notes_)};
    for (size_t s = 0; s < surfaces_.size(); ++s) {
      result.recordings.surfaces.push_back({surfaces_[s].name, std::move(executions_[s])});
      for (size_t p = 0; p < commands_.size(); ++p)
        noteFew(result.recordings.surfaces.back(), result.recordings.patterns.patterns()[p].name, p,
                result.notes);
    }
    return result;
  }

 private:
  /// The pattern with the nearest command; nullopt if none is near enough.
  std::optional<size_t> patternOf(const Command& command) const {
    std::optional<size_t> best;
    double nearest = std::max(layout_.alike, kSameCommand);
    for (size_t p = 0; p < commands_.size(); ++p) {
      const double apart = difference(command, commands_[p], largest_);
      if (apart > nearest) continue;
      nearest = apart;
      best = p;
    }
    return best;
  }

  void findCommands() {
    if (known_) return takeKnown();
    for (const CutSurface& surface : surfaces_)
      for (const CutPiece& piece : surface.pieces)
        if (!patternOf(piece.command)) commands_.push_back(piece.command);
  }

  void takeKnown() {
    const PatternSetContent& content = known_->content();
    const auto refuse = [](const std::string& why) {
      throw RecordingError("existing patterns.yaml " + why + "; write to another folder");
    };
    if (content.channels != surfaces_.front().channels)
      refuse("has commands " + describe(content.channels) + ", not " +
             describe(surfaces_.front().channels));
    if (content.period_us != std::llround(kPeriod * 1e6)) refuse("has another period than 50 ms");
    for (const MotionPattern& pattern : content.patterns) {
      const bool held = std::all_of(pattern.commands.begin(), pattern.commands.end(),
                                    [&](const Command& u) { return u == pattern.commands[0]; });
      const double lasts = kPeriod * static_cast<double>(pattern.commands.size());
      if (!held || std::abs(lasts - layout_.length) > kSameInstant)
        refuse("has a pattern '" + pattern.name + "' that is not one command held for " +
               threeDigits(layout_.length) + " s");
      commands_.push_back(pattern.commands[0]);
    }
  }

  void sort(const CutSurface& surface) {
    std::vector<std::vector<Execution>> executions(commands_.size());
    std::set<Command, CommandOrder> others;
    size_t other_pieces = 0, moved = 0;
    Eigen::MatrixXd B;
    for (const CutPiece& piece : surface.pieces) {
      const auto pattern = patternOf(piece.command);
      if (!pattern) {
        others.insert(piece.command);
        ++other_pieces;
        continue;
      }
      const bool same = difference(piece.command, commands_[*pattern], largest_) <= kSameCommand;
      if (!same && moved++ == 0) B = twistOfCommands(surface);
      executions[*pattern].push_back(same ? piece.poses : corrected(piece, commands_[*pattern], B));
    }
    if (moved > 0)
      notes_.push_back(surface.name + ": " + std::to_string(moved) + " of " +
                       std::to_string(surface.pieces.size()) +
                       " pieces are of similar commands, corrected to the pattern's");
    if (other_pieces > 0)
      notes_.push_back(surface.name + ": left out " + std::to_string(other_pieces) + " pieces of " +
                       std::to_string(others.size()) + " commands that no pattern has");
    for (std::vector<Execution>& of_pattern : executions)
      for (Execution& poses : of_pattern)
        for (Pose2& pose : poses) pose = {inMicro(pose.x), inMicro(pose.y), inMicro(pose.yaw)};
    executions_.push_back(std::move(executions));
  }

  /// The surface with the fewest pieces of a pattern.
  size_t scarcest(size_t p) const {
    size_t scarcest = 0;
    for (size_t s = 1; s < executions_.size(); ++s)
      if (executions_[s][p].size() < executions_[scarcest][p].size()) scarcest = s;
    return scarcest;
  }

  /// Drops commands with too few pieces on a surface, and notes them.
  void keepCommon() {
    std::vector<std::string> few;
    size_t kept = 0;
    for (size_t p = 0; p < commands_.size(); ++p) {
      const size_t s = scarcest(p);
      const size_t count = executions_[s][p].size();
      if (count < layout_.fewest) {
        few.push_back(patternName(commands_[p], surfaces_.front().channels) + " (" +
                      std::to_string(count) + " on " + surfaces_[s].name + ")");
        continue;
      }
      commands_[kept] = commands_[p];
      for (auto& executions : executions_)
        if (kept != p) executions[kept] = std::move(executions[p]);
      ++kept;
    }
    commands_.resize(kept);
    for (auto& executions : executions_) executions.resize(kept);
    if (few.empty()) return;
    constexpr size_t kNamed = 12;
    const size_t all = few.size();
    if (all > kNamed) few.resize(kNamed);
    const std::string line = "left out " + std::to_string(all) + " commands with fewer than " +
                             std::to_string(layout_.fewest) +
                             " pieces on a surface: " + joined(few) + (all > kNamed ? ", ..." : "");
    if (kept == 0)
      throw RecordingError(line +
                           "; no pattern is left: drive commands for longer or more often, "
                           "cut shorter pieces, or merge similar commands (--alike)");
    notes_.push_back(line);
  }

  void noteFew(const recordings::SurfaceRecordings& surface, const std::string& pattern, size_t p,
               std::vector<std::string>& notes) const {
    const size_t count = surface.executions[p].size();
    if (count < layout_.fewest)
      notes.push_back(surface.surface + ": pattern " + pattern + " has " + std::to_string(count) +
                      " executions; tread-experiment needs eight");
  }

  /// A pattern's mean twist: mean over the surfaces of the mean over its executions.
  Twist2 twistOf(size_t p) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const auto& executions : executions_)
      for (const Execution& poses : executions[p])
        sum += vectorOf(meanTwist(poses)) / static_cast<double>(executions[p].size());
    sum /= static_cast<double>(executions_.size());
    return {inMicro(sum.x()), inMicro(sum.y()), inMicro(sum.z())};
  }

  PatternSet newSet() const {
    PatternSetContent content;
    content.name = "cut";
    content.channels = surfaces_.front().channels;
    content.period_us = std::llround(kPeriod * 1e6);
    const auto samples = static_cast<size_t>(std::lround(layout_.length / kPeriod));
    std::map<std::string, int> names;
    for (size_t p = 0; p < commands_.size(); ++p) {
      Command command = commands_[p];
      for (size_t c = 0; c < content.channels.size(); ++c) command[c] = inMicro(command[c]);
      MotionPattern pattern;
      pattern.id = static_cast<int>(p) + 1;
      pattern.name = patternName(command, content.channels);
      const int before = names[pattern.name]++;
      if (before > 0) pattern.name += "_" + std::to_string(before + 1);
      pattern.entry_class = pattern.exit_class = pattern.name;
      pattern.commands.assign(samples, command);
      const Twist2 twist = twistOf(p);
      for (size_t i = 1; i <= samples; ++i)
        pattern.trajectory.push_back(integrate(twist, static_cast<double>(i) * kPeriod));
      content.classes.push_back({pattern.name, twist, command});
      content.patterns.push_back(std::move(pattern));
    }
    std::string why;
    auto set = PatternSet::make(std::move(content), why);
    if (!set) throw RecordingError("the pieces make no pattern set: " + why);
    return *set;
  }

  const std::vector<CutSurface>& surfaces_;
  const CutLayout& layout_;
  const std::optional<PatternSet>& known_;
  Command largest_;
  std::vector<Command> commands_;                                ///< of the patterns
  std::vector<std::vector<std::vector<Execution>>> executions_;  ///< by surface and pattern
  std::vector<std::string> notes_;
};

}  // namespace

void cutDrive(const RecordedDrive& drive, const CutLayout& layout, CutSurface& surface) {
  if (surface.channels.empty()) surface.channels = drive.channels;
  if (surface.channels != drive.channels)
    throw RecordingError("drives on surface '" + surface.name + "' have commands " +
                         describe(surface.channels) + " and " + describe(drive.channels) +
                         "; cut them apart, each into a folder of its own");
  Cutter(drive, layout, surface).cut();
}

CutRecordings recordingsOf(const std::vector<CutSurface>& surfaces, const CutLayout& layout,
                           const std::optional<PatternSet>& known) {
  for (const CutSurface& surface : surfaces) {
    if (surface.channels != surfaces.front().channels)
      throw RecordingError("surface '" + surface.name + "' has commands " +
                           describe(surface.channels) + ", '" + surfaces.front().name + "' " +
                           describe(surfaces.front().channels) +
                           "; cut them apart, each into a folder of its own");
    if (surface.pieces.empty())
      throw RecordingError("surface '" + surface.name +
                           "': no piece; commands must stay for longer than --offset and --cut "
                           "together, while poses are measured");
  }
  return PatternMaker(surfaces, layout, known).make();
}

std::string patternName(const Command& command, const CommandChannels& channels) {
  std::string name;
  for (size_t c = 0; c < channels.size(); ++c)
    if (command[c] != 0.0)
      name += (name.empty() ? "" : "_") + recordings::fileName(channels[c].name) +
              formatted("%+.3g", command[c]);
  if (name.empty()) return "zero";
  return name.size() + 4 <= PatternLimits::kMaxNameLength ? name : name.substr(0, 60);
}

}  // namespace tread::import
