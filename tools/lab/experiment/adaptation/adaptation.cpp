// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/experiment/adaptation/adaptation.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <stdexcept>

#include "common/config/scalars.hpp"
#include "common/parallel/parallel_for.hpp"
#include "modules/learner/core/rules/make_rule.hpp"
#include "tools/lab/experiment/adaptation/summary.hpp"
#include "tools/lab/experiment/adaptation/tuning.hpp"
#include "tools/lab/experiment/adaptation/walkers.hpp"
#include "tools/lab/experiment/end_region.hpp"
#include "tools/lab/experiment/trials.hpp"

namespace tread::adaptation {
namespace {

constexpr size_t kMostExecutions = kExecutions.back();
constexpr size_t kChained = (kHorizons.back() + 1) / 2;  // pieces of the longest prediction
constexpr size_t kLeastTraining = 60;                    // pieces

/// Sessions that are left out together, and those tested against.
struct Fold {
  HeldOut kind = HeldOut::kSession;
  std::vector<size_t> tested, training;
};

const std::string& keyOf(const SampledSession& session, HeldOut kind) {
  return kind == HeldOut::kSession   ? session.name
         : kind == HeldOut::kSurface ? session.surface
                                     : session.vehicle;
}

std::vector<Fold> foldsOf(const std::vector<SampledSession>& sessions,
                          std::vector<std::string>& notes) {
  std::vector<Fold> folds;
  for (const HeldOut kind : kAllLeftOut) {
    std::vector<std::string> done;
    for (const SampledSession& session : sessions) {
      const std::string key = session.vehicle + "\n" + keyOf(session, kind);
      if (std::find(done.begin(), done.end(), key) != done.end()) continue;
      done.push_back(key);
      Fold fold{kind, {}, {}};
      size_t pieces = 0;
      for (size_t i = 0; i < sessions.size(); ++i) {
        const bool same_vehicle = sessions[i].vehicle == session.vehicle;
        if (same_vehicle && keyOf(sessions[i], kind) == keyOf(session, kind)) {
          fold.tested.push_back(i);
        } else if ((same_vehicle || kind == HeldOut::kVehicle) &&
                   sessions[i].kind == session.kind) {
          fold.training.push_back(i);
          pieces += sessions[i].pieces.size();
        }
      }
      if (pieces >= kLeastTraining && fold.training.size() < kLeastSessions)
        notes.push_back(session.vehicle + ", " + nameOf(kind) + " " + keyOf(session, kind) +
                        " left out: fewer than " + std::to_string(kLeastSessions) +
                        " sessions are left, too few to show how grounds differ; rivals keep their "
                        "default priors, and basis has no functions");
      if (pieces >= kLeastTraining)
        folds.push_back(std::move(fold));
      else
        notes.push_back(session.vehicle + ", " + nameOf(kind) + " " + keyOf(session, kind) +
                        " left out: " + std::to_string(pieces) +
                        " pieces of driving are left; required are " +
                        std::to_string(kLeastTraining));
    }
  }
  return folds;
}

/// Results of a fold's training sessions.
struct Prepared {
  Reference reference;
  NoiseModel noise;
  std::vector<Known> home;                     ///< training sessions of the same vehicle
  std::vector<std::unique_ptr<Rival>> rivals;  ///< by rule; nullptr for rules of ours
};

Prepared prepare(const std::vector<SampledSession>& sessions, const std::vector<TermTable>& tables,
                 const Fold& fold, const Settings& settings) {
  const auto tablesWithout = [&](const std::string* key) {
    std::vector<const TermTable*> some;
    for (const size_t i : fold.training)
      if (key == nullptr || keyOf(sessions[i], fold.kind) != *key) some.push_back(&tables[i]);
    return some;
  };
  Prepared prepared{Reference(tablesWithout(nullptr)), {}, {}, {}};
  // Rivals learn how grounds differ from training sessions that their reference does not know.
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
    if (fold.kind != HeldOut::kVehicle)
      prepared.home.push_back(knownOf(sessions[i], prepared.reference, prepared.noise));
  for (const std::string& rule : settings.rules) {
    const auto& names = rivalNames();
    prepared.rivals.emplace_back();
    if (std::find(names.begin(), names.end(), rule) != names.end())
      prepared.rivals.back() = tunedRival(rule, samples, settings.seed);
  }
  return prepared;
}

/// Adds the errors of predictions that start at a piece.
void score(const SampledSession& session, const Walker& walker, size_t piece,
           std::array<Cell, kHorizons.size()>& cells) {
  const SampledSegment& segment = session.segments[session.pieces[piece].segment];
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
      const Pose2 was = between(segment.poses[begin], segment.poses[begin + wanted]);
      ++cells[h].starts;
      cells[h].position += distanceBetween(said, was);
      cells[h].yaw += std::abs(wrapAngle(said.yaw - was.yaw));
      if (i > 0 || wanted != kPieceSamples) continue;
      if (const auto stated = walker.endCovariance(piece)) {
        ++cells[h].stated;
        if (experiment::isInside(said, was, *stated)) ++cells[h].inside;
      }
    }
    at = at * poses.back();
    samples += kPieceSamples;
    if (!session.goesOn(piece + i)) return;
  }
}

std::unique_ptr<Walker> walkerOf(const Settings& settings, const Prepared& prepared, size_t rule,
                                 const Known& known, size_t first, size_t last) {
  const std::string& name = settings.rules[rule];
  if (name == kHindsight) return hindsightWalker(known);
  if (prepared.rivals[rule]) return rivalWalker(*prepared.rivals[rule], known);
  learner::RuleConfig config = settings.config;
  config.rule = name.substr(0, name.find(kHome));
  TrainingRun history;
  if (config.rule != name)
    history = drawnHistory(prepared.home, experiment::seedOf({settings.seed, first}));
  return ruleWalker(config, history, known, first, last);
}

SessionErrors testSession(const SampledSession& session, HeldOut kind, const Prepared& prepared,
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
      throw std::invalid_argument("--rules: unknown rule '" + rule + "'; known are " +
                                  joinWords(known));
    if (std::count(rules.begin(), rules.end(), rule) > 1)
      throw std::invalid_argument("--rules: '" + rule + "' is given twice");
  }
  if (std::find(rules.begin(), rules.end(), kOff) == rules.end())
    throw std::invalid_argument("--rules: 'off' is required, since errors are relative to it");
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

const char* nameOf(HeldOut what) {
  return what == HeldOut::kSession ? "session" : what == HeldOut::kSurface ? "surface" : "vehicle";
}

AdaptationErrors runAdaptation(const std::vector<SampledSession>& sessions,
                               const Settings& settings, const Progress& progress) {
  checkRules(settings.rules);
  AdaptationErrors errors;
  const std::vector<Fold> folds = foldsOf(sessions, errors.notes);
  if (folds.empty())
    throw std::runtime_error("nothing can be left out: " +
                             (errors.notes.empty() ? "there is no session" : errors.notes.front()));
  std::vector<TermTable> tables;
  for (const SampledSession& session : sessions) tables.emplace_back(session);
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
