// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/experiment/adaptation/read_recordings.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <stdexcept>

#include "common/drive/drive_log.hpp"
#include "common/recordings/recorded_drive.hpp"
#include "common/recordings/sessions.hpp"
#include "common/soundness/drive_log.hpp"
#include "common/statistics/statistics.hpp"

namespace tread::adaptation {
namespace {

namespace fs = std::filesystem;
using recordings::CommandRun;
using recordings::RecordedDrive;

// [m/s] largest difference of wheel speeds between consecutive samples
constexpr double kSameSpeed = 0.3;

gap::InsSample insSample(double time, const Pose2& T_map_body) {
  gap::InsSample sample;
  sample.time = time;
  sample.T_map_body = T_map_body;
  return sample;
}

/// Index after the last sample and fix of a separately recorded step.
template <class Entries>
size_t endOf(const Entries& entries, size_t first, double time) {
  size_t last = first;
  while (last < entries.size() && entries[last].time < time - 1e-6) ++last;
  return last;
}

/// Joins separately recorded steps, each given in the frame of its start.
/** A step continues the previous one if its wheel speeds equal the last ones there; they differ if
 * the operator took over in between. The pose of its first sample is the last one of the previous
 * step, extrapolated if a new pose was due just then. */
class StepJoiner {
 public:
  StepJoiner(const RecordedDrive& drive, const recordings::Session& session)
      : drive_(drive), lag_(session.pose_lag) {
    for (const recordings::CommandStep& step : session.steps) ok_[step.number] = step.ok;
    std::vector<double> between;
    for (size_t i = 1; i < drive.fixes.size(); ++i)
      if (!drive.fixes[i].new_track)
        between.push_back(drive.fixes[i].time - drive.fixes[i - 1].time);
    usual_ = quantileOf(between, 0.5);
  }

  std::vector<gap::Segment> segments() {
    for (const CommandRun& run : drive_.runs) take(run);
    return std::move(segments_);
  }

 private:
  void take(const CommandRun& run) {
    const size_t samples_end = endOf(drive_.drive, sample_, run.end);
    const size_t fixes_end = endOf(drive_.fixes, fix_, run.end);
    if (samples_end > sample_) {
      place(run);
      gap::Segment& segment = segments_.back();
      for (size_t i = sample_; i < samples_end; ++i)
        segment.commands.push_back(
            {drive_.drive[i].time + shift_, drive_.drive[i].command.tracks()});
      segment.end = segment.commands.back().time + kPeriod;
      const bool ok = ok_.count(run.step) > 0 && ok_[run.step];
      for (size_t i = fix_; i < fixes_end && ok; ++i)
        segment.ins.push_back(
            insSample(drive_.fixes[i].time + shift_, T_segment_step_ * drive_.fixes[i].T_map_body));
    }
    step_ = run.step;
    follows_ = fixes_end >= fix_ + 2;
    if (follows_) last_ = {drive_.fixes[fixes_end - 2], drive_.fixes[fixes_end - 1]};
    sample_ = samples_end;
    fix_ = fixes_end;
  }

  /// Places the step's samples and poses: after the previous ones, or in a new segment.
  void place(const CommandRun& run) {
    const recordings::DriveSample& first = drive_.drive[sample_];
    const bool joined =
        follows_ && run.step == step_ + 1 && sample_ > 0 &&
        std::abs(first.speed[0] - drive_.drive[sample_ - 1].speed[0]) < kSameSpeed &&
        std::abs(first.speed[1] - drive_.drive[sample_ - 1].speed[1]) < kSameSpeed;
    if (!joined) {
      segments_.emplace_back();
      segments_.back().command_before = first.speed.tracks();  // the wheels follow commands closely
      shift_ = 0.0;
      T_segment_step_ = {};
      return;
    }
    // Time of the first sample on the previous step's time axis.
    const double continued = segments_.back().commands.back().time + kPeriod;
    const double silent = continued - shift_ - (last_[1].time + lag_);
    T_segment_step_ = T_segment_step_ * last_[1].T_map_body;
    if (silent > usual_ - 0.5 * kPeriod) {
      const double dt = last_[1].time - last_[0].time;
      const Twist2 twist = twistTo(between(last_[0].T_map_body, last_[1].T_map_body), dt);
      T_segment_step_ = T_segment_step_ * integrate(twist, silent);
    }
    shift_ = continued - first.time;
  }

  const RecordedDrive& drive_;
  double lag_;
  double usual_ = 0.0;  ///< [s] between poses
  std::map<int, bool> ok_;
  std::vector<gap::Segment> segments_;
  size_t sample_ = 0, fix_ = 0;
  int step_ = 0;
  bool follows_ = false;  ///< the previous step has the two final fixes needed for joining
  std::array<recordings::Fix, 2> last_;
  double shift_ = 0.0;  ///< [s]
  Pose2 T_segment_step_;
};

/// The parts of a whole log that the program drove, without poses of steps that are not ok.
std::vector<gap::Segment> automaticSegments(const RecordedDrive& drive,
                                            const recordings::Session& session) {
  std::vector<gap::Segment> segments;
  size_t fix = 0;
  for (size_t i = 0; i < drive.drive.size(); ++i) {
    const recordings::DriveSample& sample = drive.drive[i];
    if (!sample.automatic) continue;
    const bool goes_on = i > 0 && drive.drive[i - 1].automatic &&
                         sample.time - drive.drive[i - 1].time < 2.0 * kPeriod;
    if (!goes_on) segments.emplace_back();
    segments.back().commands.push_back({sample.time, sample.command.tracks()});
    segments.back().end = sample.time + kPeriod;
  }
  const auto isBad = [&](double time) {
    return std::any_of(drive.runs.begin(), drive.runs.end(), [&](const CommandRun& run) {
      const auto step = std::find_if(session.steps.begin(), session.steps.end(),
                                     [&](const auto& s) { return s.number == run.step; });
      return time >= run.begin && time < run.end && step != session.steps.end() && !step->ok;
    });
  };
  for (gap::Segment& segment : segments)
    for (; fix < drive.fixes.size() && drive.fixes[fix].time < segment.end; ++fix)
      if (drive.fixes[fix].time > segment.begin() - kLongestGap && !isBad(drive.fixes[fix].time))
        segment.ins.push_back(insSample(drive.fixes[fix].time, drive.fixes[fix].T_map_body));
  return segments;
}

/// Baseline of a vehicle: that of most of its steps.
std::map<std::string, double> usualBaselines(const std::vector<recordings::Session>& sessions) {
  std::map<std::string, std::map<double, size_t>> steps;
  for (const recordings::Session& session : sessions)
    if (session.problem.empty()) steps[session.robot][session.baseline] += session.steps.size();
  std::map<std::string, double> usual;
  for (const auto& [robot, counts] : steps)
    usual[robot] = std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) {
                     return a.second < b.second;
                   })->first;
  return usual;
}

SampledSession sessionOf(const fs::path& folder, const recordings::Session& listed,
                         double baseline) {
  SampledSession session;
  session.name = listed.name;
  session.vehicle = listed.robot;
  session.surface = listed.surface;
  session.baseline = baseline;
  recordings::Session known =
      recordings::readSession((folder / "sessions.csv").string(), listed.name);
  known.steps = listed.steps;
  const fs::path whole = folder / "continuous" / (listed.name + ".csv");
  if (fs::exists(whole)) {
    const RecordedDrive drive = recordings::readContinuous(whole.string(), known);
    for (const gap::Segment& segment : automaticSegments(drive, known))
      session.segments.push_back(sampled(segment, false));
    return session;
  }
  const RecordedDrive drive =
      recordings::readSteps((folder / "steps" / (listed.name + ".csv")).string(), known);
  for (const gap::Segment& segment : StepJoiner(drive, known).segments())
    session.segments.push_back(sampled(segment, true));
  return session;
}

void readDrives(const fs::path& folder, Recordings& found) {
  const std::vector<recordings::Session> listed = recordings::readSessions(folder.string());
  const std::map<std::string, double> baselines = usualBaselines(listed);
  for (const recordings::Session& session : listed) {
    if (!session.problem.empty()) {
      found.notes.push_back(session.problem);
      continue;
    }
    found.sessions.push_back(sessionOf(folder, session, baselines.at(session.robot)));
  }
}

void readLogs(const std::vector<fs::path>& logs, Recordings& found) {
  for (const fs::path& path : logs) {
    const gap::Drive drive = gap::readDrive(path.string());
    if (drive.layout != VehicleLayout::kTracks) {
      found.notes.push_back(path.stem().string() + ": left out: recorded with " +
                            nameOf(drive.layout) + "; the rivals are for two tracks");
      continue;
    }
    const DriveLog log = readDriveLog({path.string()});
    if (!log.problem.empty()) found.notes.push_back(path.stem().string() + ": " + log.problem);
    SampledSession session;
    session.name = path.stem().string();
    session.vehicle = "unknown vehicle";
    session.surface = log.surfaces.empty() ? "unknown" : log.surfaces.begin()->second;
    session.kind = drive.kind;
    if (drive.imported && !drive.imported->robot.empty()) session.vehicle = drive.imported->robot;
    if (drive.imported && drive.imported->baseline > 0.0)
      session.baseline = drive.imported->baseline;
    for (const gap::Segment& segment : drive.segments)
      session.segments.push_back(sampled(segment, false));
    found.sessions.push_back(std::move(session));
  }
}

}  // namespace

Recordings readRecordings(const std::string& folder) {
  Recordings found;
  std::vector<fs::path> logs;
  std::error_code unreadable;
  for (const auto& entry : fs::directory_iterator(folder, unreadable))
    if (entry.path().extension() == ".lcmlog") logs.push_back(entry.path());
  std::sort(logs.begin(), logs.end());
  if (fs::exists(fs::path(folder) / "sessions.csv", unreadable))
    readDrives(folder, found);
  else if (!logs.empty())
    readLogs(logs, found);
  else
    throw std::runtime_error(
        folder +
        ": contains neither sessions.csv (drives) nor *.lcmlog (logs of drives)"
        "; check --recordings");
  for (SampledSession& session : found.sessions) cutPieces(session);
  const auto empty =
      std::stable_partition(found.sessions.begin(), found.sessions.end(),
                            [](const SampledSession& session) { return !session.pieces.empty(); });
  for (auto session = empty; session != found.sessions.end(); ++session)
    found.notes.push_back(session->name +
                          ": less than two seconds of driving under known commands");
  found.sessions.erase(empty, found.sessions.end());
  return found;
}

}  // namespace tread::adaptation
