// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/experiment/adaptation/walkers.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "modules/learner/core/rules/ground_model.hpp"
#include "modules/learner/core/rules/make_rule.hpp"
#include "tools/lab/experiment/adaptation/tuning.hpp"
#include "tools/lab/experiment/trials.hpp"

namespace tread::adaptation {
namespace {

constexpr size_t kHistory = 20;  // pieces

/// A piece and its session.
struct Driven {
  const Known* known;
  size_t piece;

  const SampledPiece& measured() const { return known->session.pieces[piece]; }
};

/// A piece as a pattern: predicted by the reference, with the covariance of its noise.
MotionPattern patternOf(const Driven& driven, int id) {
  const SampledPiece& piece = driven.measured();
  const auto begin = driven.known->session.segments[piece.segment].commands.begin() +
                     static_cast<std::ptrdiff_t>(piece.begin);
  MotionPattern pattern;
  pattern.id = id;
  pattern.name = "piece" + std::to_string(id);
  pattern.entry_class = pattern.exit_class = "driving";
  pattern.commands.assign(begin, begin + kPieceSamples);
  pattern.trajectory = integrated(driven.known->reference.twists[driven.piece]);
  const Eigen::Matrix3d lever = learner::TwistProfile(pattern, kPeriod).endLever();
  const Eigen::Matrix3d P =
      lever * driven.known->reference.samples[driven.piece].noise.asDiagonal() * lever.transpose();
  pattern.end_covariance = {P(0, 0), P(0, 1), P(0, 2), P(1, 1), P(1, 2), P(2, 2)};
  return pattern;
}

class RuleWalker : public Walker {
 public:
  RuleWalker(const learner::RuleConfig& config, std::vector<Driven> pieces, size_t history,
             size_t first)
      : pieces_(std::move(pieces)), history_(history), first_(first) {
    PatternSetContent content;
    content.name = "pieces";
    content.channels = trackChannels(pieces_.back().known->session.kind);
    content.period_us = std::lround(kPeriod * 1e6);
    content.classes.push_back({"driving", {}, {}});
    for (const Driven& driven : pieces_)
      content.patterns.push_back(patternOf(driven, static_cast<int>(content.patterns.size())));
    std::string why;
    const std::optional<PatternSet> set = PatternSet::make(std::move(content), why);
    if (!set) throw std::runtime_error(pieces_.back().known->session.name + ": " + why);
    rule_ = learner::makeRule(config, *set);
    for (size_t i = 0; i < history_; ++i) execute(i);
  }

  void learn(size_t piece) override { execute(history_ + piece - first_); }
  std::vector<Pose2> predict(size_t piece) const override {
    std::vector<double> numbers(3 * kPieceSamples);
    rule_->predict(history_ + piece - first_, {numbers.data(), kPieceSamples, 3});
    return learner::posesOf({numbers.data(), kPieceSamples, 3});
  }
  std::optional<PoseCovariance> endCovariance(size_t piece) const override {
    return rule_->endCovariance(history_ + piece - first_);
  }

 private:
  void execute(size_t pattern) {
    std::vector<double> numbers;
    learner::fill(pieces_[pattern].measured().measured, numbers);
    learner::RuleNote note;
    rule_->learn(pattern, {numbers.data(), kPieceSamples, 3}, note);
  }

  std::vector<Driven> pieces_;
  size_t history_;  ///< number of pieces before the session
  size_t first_;    ///< first piece of the session, after the history
  std::unique_ptr<learner::LearningRule> rule_;
};

class RivalWalker : public Walker {
 public:
  RivalWalker(std::unique_ptr<Rival> rival, const Known& known)
      : rival_(std::move(rival)), known_(known) {}

  void learn(size_t piece) override { rival_->learn(known_.reference.samples[piece]); }
  std::vector<Pose2> predict(size_t piece) const override {
    return integrated(
        rival_->corrected(known_.reference.twists[piece], known_.reference.samples[piece]));
  }

 private:
  std::unique_ptr<Rival> rival_;
  const Known& known_;
};

class HindsightWalker : public RivalWalker {
 public:
  explicit HindsightWalker(const Known& known)
      : RivalWalker(hindsight(known.reference.samples), known) {}
  void learn(size_t) override {}
};

}  // namespace

Known knownOf(const SampledSession& session, const Reference& reference, const NoiseModel& noise) {
  Known known{session, predicted(session, reference)};
  for (Sample& sample : known.reference.samples) sample.noise = noise.of(sample.meanSpeed());
  return known;
}

TrainingRun drawnHistory(const std::vector<Known>& home, uint64_t seed) {
  if (home.empty()) return {};
  std::mt19937_64 random(seed);
  const Known& known = home[experiment::drawIndex(random, home.size())];
  const size_t length = std::min(kHistory, known.session.pieces.size());
  const size_t begin = experiment::drawIndex(random, known.session.pieces.size() - length + 1);
  return {&known, begin, begin + length};
}

std::unique_ptr<Walker> ruleWalker(const learner::RuleConfig& config, const TrainingRun& history,
                                   const Known& known, size_t first, size_t last) {
  std::vector<Driven> pieces;
  for (size_t i = history.begin; i < history.end; ++i) pieces.push_back({history.known, i});
  for (size_t i = first; i < last; ++i) pieces.push_back({&known, i});
  return std::make_unique<RuleWalker>(config, std::move(pieces), history.end - history.begin,
                                      first);
}

std::unique_ptr<Walker> rivalWalker(const Rival& fresh, const Known& known) {
  return std::make_unique<RivalWalker>(fresh.clone(), known);
}

std::unique_ptr<Walker> hindsightWalker(const Known& known) {
  return std::make_unique<HindsightWalker>(known);
}

}  // namespace tread::adaptation
