// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/experiment/rival_rule.hpp"

#include <algorithm>

#include "tools/lab/experiment/adaptation/tuning.hpp"

namespace tread::experiment {
namespace {

using adaptation::Sample;
using learner::ConstTrajectory;

constexpr size_t kMostTraining = 62;  // executions of a surface: two tuning runs
constexpr uint64_t kFeatureSeed = 1;  // of random features

std::vector<Twist2> twistsOf(const std::vector<Pose2>& poses, double period) {
  std::vector<Twist2> twists;
  Pose2 before;
  for (const Pose2& pose : poses) {
    twists.push_back(twistTo(between(before, pose), period));
    before = pose;
  }
  return twists;
}

Eigen::Vector3d meanTwist(const ConstTrajectory& measured, double period) {
  return adaptation::sampleOf(twistsOf(learner::posesOf(measured), period)).twist;
}

/// Variances of the mean twist over the executions of each pattern.
std::vector<Eigen::Vector3d> noiseOf(const TrialGround& ground) {
  constexpr double kLeast = 1e-8;  // [m^2/s^2], [rad^2/s^2]: least variance
  const double period = ground.averaged.periodSeconds();
  std::vector<Eigen::Vector3d> noise;
  for (const Executions& known : ground.known) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero(), squares = Eigen::Vector3d::Zero();
    const auto n = static_cast<double>(known.size());
    for (size_t i = 0; i < known.size(); ++i) {
      const Eigen::Vector3d twist = meanTwist(known.of(i), period);
      sum += twist;
      squares += twist.cwiseAbs2();
    }
    noise.push_back(((squares - sum.cwiseAbs2() / n) / std::max(1.0, n - 1.0)).cwiseMax(kLeast));
  }
  return noise;
}

/// Residuals of the known executions of a surface relative to another surface's set, by pattern.
std::vector<Sample> samplesOf(const TrialGround& ground, const std::vector<Sample>& reference) {
  const double period = ground.averaged.periodSeconds();
  std::vector<Sample> samples;
  for (size_t i = 0; samples.size() < kMostTraining; ++i) {
    const size_t before = samples.size();
    for (size_t p = 0; p < ground.known.size() && samples.size() < kMostTraining; ++p) {
      if (i >= ground.known[p].size()) continue;
      samples.push_back(reference[p]);
      samples.back().residual = meanTwist(ground.known[p].of(i), period) - reference[p].twist;
    }
    if (samples.size() == before) break;
  }
  return samples;
}

std::vector<Sample> referenceOf(const TrialGround& ground) {
  const std::vector<Eigen::Vector3d> noise = noiseOf(ground);
  std::vector<Sample> samples;
  for (const MotionPattern& pattern : ground.averaged.patterns()) {
    samples.push_back(
        adaptation::sampleOf(twistsOf(pattern.trajectory, ground.averaged.periodSeconds())));
    samples.back().noise = noise[samples.size() - 1];
  }
  return samples;
}

}  // namespace

RivalRule::RivalRule(std::unique_ptr<adaptation::Rival> rival, const PatternSet& shipped,
                     const std::vector<Eigen::Vector3d>& noise)
    : rival_(std::move(rival)) {
  Reference reference{shipped.periodSeconds(), {}, {}};
  for (const MotionPattern& pattern : shipped.patterns()) {
    reference.twists.push_back(twistsOf(pattern.trajectory, reference.period));
    reference.samples.push_back(adaptation::sampleOf(reference.twists.back()));
    reference.samples.back().noise = noise[reference.samples.size() - 1];
  }
  reference_ = std::make_shared<const Reference>(std::move(reference));
}

RivalRule::RivalRule(const RivalRule& other)
    : reference_(other.reference_), rival_(other.rival_->clone()) {}

void RivalRule::learn(size_t executed, const ConstTrajectory& measured, learner::RuleNote&) {
  Sample sample = reference_->samples[executed];
  sample.residual = meanTwist(measured, reference_->period) - sample.twist;
  rival_->learn(sample);
}

std::vector<Pose2> RivalRule::poses(size_t pattern) const {
  return adaptation::integrated(
      rival_->corrected(reference_->twists[pattern], reference_->samples[pattern]),
      reference_->period);
}

void RivalRule::predict(size_t pattern, learner::Trajectory prediction) const {
  std::vector<double> numbers;
  learner::fill(poses(pattern), numbers);
  std::copy(numbers.begin(), numbers.end(), prediction.data());
}

Pose2 RivalRule::predictEnd(size_t pattern) const {
  return poses(pattern).back();
}

void RivalRule::assign(const learner::LearningRule& other) {
  rival_ = static_cast<const RivalRule&>(other).rival_->clone();
}

Rivals tunedRivals(const std::vector<std::string>& methods, const std::vector<TrialGround>& grounds,
                   size_t from, size_t to) {
  const std::vector<Sample> reference = referenceOf(grounds[from]);
  adaptation::TrainingSamples training;
  Rivals rivals;
  for (const std::string& name : methods) {
    const std::string rule = methodOf(name)->rule;
    const auto& known = adaptation::rivalNames();
    if (std::find(known.begin(), known.end(), rule) == known.end() || rivals.count(rule) > 0)
      continue;
    if (training.empty())
      for (size_t s = 0; s < grounds.size(); ++s)
        if (s != to) training.push_back(samplesOf(grounds[s], reference));
    rivals[rule] = adaptation::tunedRival(rule, training, kFeatureSeed);
  }
  return rivals;
}

std::unique_ptr<learner::LearningRule> rivalRule(const adaptation::Rival& rival,
                                                 const TrialGround& ground) {
  return std::make_unique<RivalRule>(rival.clone(), ground.averaged, noiseOf(ground));
}

}  // namespace tread::experiment
