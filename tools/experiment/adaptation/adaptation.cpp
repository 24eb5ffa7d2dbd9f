// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/experiment/adaptation/adaptation.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <stdexcept>

#include "common/config/scalars.hpp"
#include "common/parallel/parallel_for.hpp"
#include "tools/experiment/adaptation/rivals.hpp"
#include "tools/experiment/trials.hpp"

namespace tread::adaptation {
namespace {

constexpr size_t kMostExecutions = kExecutions.back();
constexpr size_t kChained = (kHorizons.back() + 1) / 2;  // pieces of the longest prediction
constexpr size_t kLeastTraining = 60;                    // pieces
constexpr size_t kHistory = 20;                          // pieces
constexpr const char* kHome = "_home";

/// A learner on the pieces of one walk.
class Walker {
 public:
  virtual ~Walker() = default;
  virtual void learn(size_t piece) = 0;
  /// Poses after each sample, relative to the piece's start.
  virtual std::vector<Pose2> predict(size_t piece) const = 0;
};

/// A session, and what the reference says of it.
struct Known {
  const Session& session;
  Predicted reference;
};

Known knownOf(const Session& session, const Reference& reference, const NoiseModel& noise) {
  Known known{session, predicted(session, reference)};
  for (Sample& sample : known.reference.samples) sample.noise = noise.of(sample.meanSpeed());
  return known;
}

/// Covariance of the end of a piece whose mean twist scatters as the noise model says.
PoseCovariance endCovariance(const std::vector<Twist2>& twists, const Eigen::Vector3d& noise) {
  Eigen::Matrix3d lever;
  constexpr double kStep = 1e-4;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const auto end = [&](double change) {
      std::vector<Twist2> moved = twists;
      for (Twist2& twist : moved)
        (axis == 0 ? twist.v_x : axis == 1 ? twist.v_y : twist.omega) += change;
      const Pose2 pose = integrated(moved).back();
      return Eigen::Vector3d(pose.x, pose.y, pose.yaw);
    };
    lever.col(axis) = (end(kStep) - end(-kStep)) / (2.0 * kStep);
  }
  const Eigen::Matrix3d P = lever * noise.asDiagonal() * lever.transpose();
  return {P(0, 0), P(0, 1), P(0, 2), P(1, 1), P(1, 2), P(2, 2)};
}

/// A piece of a session, wherever it was driven.
struct Driven {
  const Known* known;
  size_t piece;

  const Piece& measured() const { return known->session.pieces[piece]; }
};

MotionPattern patternOf(const Driven& driven, int id) {
  const Piece& piece = driven.measured();
  const auto begin = driven.known->session.stretches[piece.stretch].commands.begin() +
                     static_cast<std::ptrdiff_t>(piece.begin);
  const std::vector<Twist2>& twists = driven.known->reference.twists[driven.piece];
  MotionPattern pattern;
  pattern.id = id;
  pattern.name = "piece" + std::to_string(id);
  pattern.entry_class = pattern.exit_class = "driving";
  pattern.commands.assign(begin, begin + kPieceSamples);
  pattern.trajectory = integrated(twists);
  pattern.end_covariance =
      endCovariance(twists, driven.known->reference.samples[driven.piece].noise);
  return pattern;
}

/// A rule of the learner. Its set is made of the pieces that it executes, those of its history
/// first, and of those that it predicts.
class RuleWalker : public Walker {
 public:
  RuleWalker(const learner::RuleConfig& config, std::vector<Driven> pieces, size_t history,
             size_t first)
      : pieces_(std::move(pieces)), history_(history), first_(first) {
    PatternSetContent content;
    content.name = "pieces";
    content.kind = pieces_.back().known->session.kind;
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

 private:
  void execute(size_t pattern) {
    std::vector<double> numbers;
    learner::fill(pieces_[pattern].measured().measured, numbers);
    learner::RuleNote note;
    rule_->learn(pattern, {numbers.data(), kPieceSamples, 3}, note);
  }

  std::vector<Driven> pieces_;
  size_t history_;  ///< so many of them come before the session
  size_t first_;    ///< of the session, behind them
  std::unique_ptr<learner::LearningRule> rule_;
};

class RivalWalker : public Walker {
 public:
  RivalWalker(const Rival& fresh, const Known& known) : rival_(fresh), known_(known) {}

  void learn(size_t piece) override { rival_.learn(known_.reference.samples[piece]); }
  std::vector<Pose2> predict(size_t piece) const override {
    return integrated(
        rival_.corrected(known_.reference.twists[piece], known_.reference.samples[piece]));
  }

 private:
  Rival rival_;
  const Known& known_;
};

/// Knows the whole session and learns no more.
class HindsightWalker : public RivalWalker {
 public:
  explicit HindsightWalker(const Known& known)
      : RivalWalker(hindsight(known.reference.samples), known) {}
  void learn(size_t) override {}
};

/// What is left out at once, and what it is tested against.
struct Fold {
  LeftOut kind = LeftOut::kSession;
  std::vector<size_t> tested, training;
};

const std::string& keyOf(const Session& session, LeftOut kind) {
  return kind == LeftOut::kSession   ? session.name
         : kind == LeftOut::kSurface ? session.surface
                                     : session.vehicle;
}

std::vector<Fold> foldsOf(const std::vector<Session>& sessions, std::vector<std::string>& notes) {
  std::vector<Fold> folds;
  for (const LeftOut kind : kAllLeftOut) {
    std::vector<std::string> done;
    for (const Session& session : sessions) {
      const std::string key = session.vehicle + "\n" + keyOf(session, kind);
      if (std::find(done.begin(), done.end(), key) != done.end()) continue;
      done.push_back(key);
      Fold fold{kind, {}, {}};
      size_t pieces = 0;
      for (size_t i = 0; i < sessions.size(); ++i) {
        const bool same_vehicle = sessions[i].vehicle == session.vehicle;
        if (same_vehicle && keyOf(sessions[i], kind) == keyOf(session, kind)) {
          fold.tested.push_back(i);
        } else if (same_vehicle || kind == LeftOut::kVehicle) {
          fold.training.push_back(i);
          pieces += sessions[i].pieces.size();
        }
      }
      if (pieces >= kLeastTraining)
        folds.push_back(std::move(fold));
      else
        notes.push_back(session.vehicle + ", " + nameOf(kind) + " " + keyOf(session, kind) +
                        " left out: " + std::to_string(pieces) +
                        " pieces of driving are left, needed are " +
                        std::to_string(kLeastTraining));
    }
  }
  return folds;
}

/// What a fold makes of its training sessions.
struct Prepared {
  Reference reference;
  NoiseModel noise;
  std::vector<Known> home;                   ///< training sessions of the same vehicle
  std::vector<std::optional<Rival>> rivals;  ///< by rule; nothing for rules of ours
};

Prepared prepare(const std::vector<Session>& sessions, const std::vector<TermTable>& tables,
                 const Fold& fold, const Settings& settings) {
  const auto tablesWithout = [&](const std::string* key) {
    std::vector<const TermTable*> some;
    for (const size_t i : fold.training)
      if (key == nullptr || keyOf(sessions[i], fold.kind) != *key) some.push_back(&tables[i]);
    return some;
  };
  Prepared prepared{Reference(tablesWithout(nullptr)), {}, {}, {}};
  // What rivals expect of new ground is seen on training sessions that a reference does not know.
  TrainingSamples samples;
  for (const size_t i : fold.training) {
    const auto others = tablesWithout(&keyOf(sessions[i], fold.kind));
    const Reference without =
        others.empty() ? prepared.reference : Reference(others, prepared.reference);
    samples.push_back(predicted(sessions[i], without).samples);
  }
  prepared.noise = noiseOf(samples);
  for (std::vector<Sample>& session : samples)
    for (Sample& sample : session) sample.noise = prepared.noise.of(sample.meanSpeed());
  for (const size_t i : fold.training)
    if (fold.kind != LeftOut::kVehicle)
      prepared.home.push_back(knownOf(sessions[i], prepared.reference, prepared.noise));
  for (const std::string& rule : settings.rules) {
    const auto& names = rivalNames();
    prepared.rivals.emplace_back();
    if (std::find(names.begin(), names.end(), rule) != names.end())
      prepared.rivals.back() = tunedRival(rule, samples, settings.seed);
  }
  return prepared;
}

/// Adds the errors of predictions that begin at a piece.
void score(const Session& session, const Walker& walker, size_t piece,
           std::array<Cell, kHorizons.size()>& cells) {
  const Stretch& stretch = session.stretches[session.pieces[piece].stretch];
  const size_t begin = session.pieces[piece].begin;
  Pose2 at;
  size_t samples = 0;
  for (size_t i = 0; i < kChained; ++i) {
    const std::vector<Pose2> poses = walker.predict(piece + i);
    for (size_t h = 0; h < kHorizons.size(); ++h) {
      const auto wanted =
          static_cast<size_t>(std::lround(static_cast<double>(kHorizons[h]) / kPeriod));
      if (wanted <= samples || wanted > samples + kPieceSamples) continue;
      const Pose2 said = at * poses[wanted - samples - 1];
      const Pose2 was = between(stretch.poses[begin], stretch.poses[begin + wanted]);
      ++cells[h].starts;
      cells[h].position += distanceBetween(said, was);
      cells[h].yaw += std::abs(wrapAngle(said.yaw - was.yaw));
    }
    at = at * poses.back();
    samples += kPieceSamples;
    if (!session.goesOn(piece + i)) return;
  }
}

/// A run of pieces of a training session, drawn by chance; none where there is no session.
std::vector<Driven> drawnHistory(const std::vector<Known>& home, uint64_t seed) {
  std::vector<Driven> history;
  if (home.empty()) return history;
  std::mt19937_64 random(seed);
  const Known& known = home[experiment::drawIndex(random, home.size())];
  const size_t pieces = known.session.pieces.size();
  const size_t length = std::min(kHistory, pieces);
  const size_t begin = experiment::drawIndex(random, pieces - length + 1);
  for (size_t i = begin; i < begin + length; ++i) history.push_back({&known, i});
  return history;
}

std::unique_ptr<Walker> walkerOf(const Settings& settings, const Prepared& prepared, size_t rule,
                                 const Known& known, size_t first, size_t last) {
  const std::string& name = settings.rules[rule];
  if (name == kHindsight) return std::make_unique<HindsightWalker>(known);
  if (prepared.rivals[rule]) return std::make_unique<RivalWalker>(*prepared.rivals[rule], known);
  learner::RuleConfig config = settings.config;
  config.rule = name.substr(0, name.find(kHome));
  std::vector<Driven> pieces;
  if (config.rule != name)
    pieces = drawnHistory(prepared.home, experiment::seedOf({settings.seed, first}));
  const size_t history = pieces.size();
  for (size_t i = first; i < last; ++i) pieces.push_back({&known, i});
  return std::make_unique<RuleWalker>(config, std::move(pieces), history, first);
}

SessionErrors testSession(const Session& session, LeftOut kind, const Prepared& prepared,
                          const Settings& settings) {
  const Known known = knownOf(session, prepared.reference, prepared.noise);
  SessionErrors errors{kind, session.name, session.vehicle, session.surface, {}};
  errors.cells.resize(settings.rules.size());
  const size_t pieces = session.pieces.size();
  const size_t starts = std::min(settings.starts, pieces);
  for (size_t rule = 0; rule < settings.rules.size(); ++rule) {
    auto& cells = errors.cells[rule];
    for (size_t s = 0; s < starts; ++s) {
      const size_t first = s * pieces / starts;
      const size_t last = std::min(pieces, first + kMostExecutions + kChained);
      const auto walker = walkerOf(settings, prepared, rule, known, first, last);
      for (size_t k = 0; k <= kMostExecutions && first + k < pieces; ++k) {
        const auto asked = std::find(kExecutions.begin(), kExecutions.end(), k);
        if (asked != kExecutions.end())
          score(session, *walker, first + k,
                cells[static_cast<size_t>(asked - kExecutions.begin())]);
        walker->learn(first + k);
      }
    }
    for (auto& of_k : cells)
      for (Cell& cell : of_k)
        if (cell.starts > 0) {
          cell.position /= static_cast<double>(cell.starts);
          cell.yaw /= static_cast<double>(cell.starts);
        }
  }
  return errors;
}

void checkRules(const std::vector<std::string>& rules) {
  const std::vector<std::string> known = knownRules();
  for (const std::string& rule : rules) {
    if (std::find(known.begin(), known.end(), rule) == known.end())
      throw std::invalid_argument("--rules: there is no rule '" + rule + "'; known are " +
                                  joinWords(known));
    if (std::count(rules.begin(), rules.end(), rule) > 1)
      throw std::invalid_argument("--rules: '" + rule + "' is there twice; each rule once");
  }
  if (std::find(rules.begin(), rules.end(), kOff) == rules.end())
    throw std::invalid_argument("--rules: 'off' is needed, all errors are told over its own");
}

}  // namespace

std::vector<std::string> knownRules() {
  std::vector<std::string> names;
  for (const std::string& rule : learner::ruleNames()) {
    names.push_back(rule);
    if (rule != kOff) names.push_back(rule + kHome);
  }
  names.insert(names.end(), rivalNames().begin(), rivalNames().end());
  names.emplace_back(kHindsight);
  return names;
}

std::vector<std::string> defaultRules() {
  std::vector<std::string> names{kOff, "collective", kJudged, std::string(kJudged) + kHome};
  names.insert(names.end(), rivalNames().begin(), rivalNames().end());
  names.emplace_back(kHindsight);
  return names;
}

const char* nameOf(LeftOut what) {
  return what == LeftOut::kSession ? "session" : what == LeftOut::kSurface ? "surface" : "vehicle";
}

Errors runAdaptation(const std::vector<Session>& sessions, const Settings& settings,
                     const Progress& progress) {
  checkRules(settings.rules);
  Errors errors;
  const std::vector<Fold> folds = foldsOf(sessions, errors.notes);
  if (folds.empty())
    throw std::runtime_error("nothing can be left out: " +
                             (errors.notes.empty() ? "there is no session" : errors.notes.front()));
  std::vector<TermTable> tables;
  for (const Session& session : sessions) tables.emplace_back(session);
  std::vector<std::vector<SessionErrors>> results(folds.size());
  std::mutex mutex;  // guards what follows
  size_t done = 0;
  onThreads(settings.threads)(folds.size(), [&](size_t i) {
    const Prepared prepared = prepare(sessions, tables, folds[i], settings);
    for (const size_t tested : folds[i].tested)
      results[i].push_back(testSession(sessions[tested], folds[i].kind, prepared, settings));
    const std::lock_guard<std::mutex> lock(mutex);
    ++done;
    if (progress) progress(done, folds.size());
  });
  for (std::vector<SessionErrors>& of_fold : results)
    for (SessionErrors& session : of_fold) errors.sessions.push_back(std::move(session));
  return errors;
}

}  // namespace tread::adaptation
