// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/replay/pose_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>
#include <sstream>
#include <stdexcept>

namespace tread::replay {
namespace {

/// The same drive with another channel's poses instead of INS.
std::vector<LogEvent> posesFrom(const std::string& channel, std::vector<LogEvent> events) {
  events.erase(std::remove_if(events.begin(), events.end(),
                              [](const LogEvent& event) { return event.channel == kIns.name; }),
               events.end());
  for (LogEvent& event : events)
    if (event.channel == channel) event.channel = kIns.name;
  return events;
}

int64_t acceptedIn(const LearnerRun& run) {
  return std::count_if(run.learned.begin(), run.learned.end(),
                       [](const learning_t& learned) { return learned.accepted; });
}

EndChanges between(const PatternSet& from, const PatternSet& to) {
  EndChanges changes;
  for (const MotionPattern& pattern : from.patterns()) {
    const MotionPattern* other = to.find(pattern.id);
    if (other == nullptr) continue;
    const Pose2 step = tread::between(pattern.end(), other->end());
    changes.position += std::hypot(step.x, step.y);
    changes.yaw += std::abs(step.yaw);
  }
  return changes;
}

void compareMeasured(const LearnerRun& a, const LearnerRun& b, PoseComparison& comparison) {
  std::map<std::pair<int64_t, int64_t>, const learning_t*> of_b;
  for (const learning_t& one : b.learned)
    if (one.accepted) of_b[{one.learned_run_id, one.learned_execution_id}] = &one;
  double position = 0.0, yaw = 0.0, count = 0.0;
  for (const learning_t& one : a.learned) {
    const auto other = of_b.find({one.learned_run_id, one.learned_execution_id});
    if (!one.accepted || other == of_b.end()) continue;
    const double* p = one.measured_end;
    const double* q = other->second->measured_end;
    if (!std::isfinite(p[0] + p[1] + p[2] + q[0] + q[1] + q[2])) continue;
    position += (p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]);
    yaw += wrapAngle(p[2] - q[2]) * wrapAngle(p[2] - q[2]);
    ++count;
  }
  comparison.measured_apart = std::sqrt(position / std::max(1.0, count));
  comparison.measured_yaw_apart = std::sqrt(yaw / std::max(1.0, count));
}

}  // namespace

PoseComparison comparePoses(const std::string& name, const std::vector<LogEvent>& events,
                            const std::string& channel, const learner::LearnerNodeConfig& config) {
  const bool there = std::any_of(events.begin(), events.end(),
                                 [&](const LogEvent& event) { return event.channel == channel; });
  if (!there)
    throw std::runtime_error(name + ": no " + channel +
                             "; record a drive with scan_matching (channel: SCAN_MATCHING)");
  const auto run = [&](const std::vector<LogEvent>& heard) {
    return runLearner(toLearnerLog(name, heard), config, Commitment::kAhead, channel);
  };
  const LearnerRun with_ins = run(events);
  const LearnerRun with_other = run(posesFrom(channel, events));
  PoseComparison comparison;
  comparison.channel = channel;
  comparison.learned_with_ins = acceptedIn(with_ins);
  comparison.learned_with_other = acceptedIn(with_other);
  comparison.errors_with_ins = summarise(with_ins.learned);
  comparison.errors_with_other = summarise(with_other.learned);
  comparison.patterns = config.shipped.patterns().size();
  comparison.corrected = between(config.shipped, *with_ins.set);
  comparison.apart = between(*with_ins.set, *with_other.set);
  compareMeasured(with_ins, with_other, comparison);
  return comparison;
}

std::string reportOf(const PoseComparison& comparison) {
  const auto count = static_cast<double>(std::max<size_t>(1, comparison.patterns));
  const auto percent = [](double part, double whole) {
    return whole > 0.0 ? 100.0 * part / whole : 0.0;
  };
  std::ostringstream out;
  out << std::fixed << std::setprecision(4) << "learned from " << comparison.learned_with_ins
      << " executions with INS, from " << comparison.learned_with_other << " with "
      << comparison.channel << "\n  their measured ends are " << comparison.measured_apart << " m "
      << comparison.measured_yaw_apart
      << " rad apart (root mean square)\n  mean prediction error with INS "
      << comparison.errors_with_ins.position_mean << " m " << comparison.errors_with_ins.yaw_mean
      << " rad, with " << comparison.channel << " " << comparison.errors_with_other.position_mean
      << " m " << comparison.errors_with_other.yaw_mean << " rad\n  corrections of "
      << comparison.patterns << " patterns with INS: mean " << comparison.corrected.position / count
      << " m " << comparison.corrected.yaw / count << " rad; with " << comparison.channel
      << " they differ from these by " << comparison.apart.position / count << " m "
      << comparison.apart.yaw / count << " rad: " << std::setprecision(1)
      << percent(comparison.apart.position, comparison.corrected.position) << " % "
      << percent(comparison.apart.yaw, comparison.corrected.yaw) << " %\n";
  return out.str();
}

}  // namespace tread::replay
