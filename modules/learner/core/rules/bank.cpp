// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/rules/surface_bank.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "modules/learner/core/rules/ground_filter.hpp"

namespace tread::learner {
namespace {

/// A surface is sure with more than this [1].
constexpr double kSure = 0.9;
/// Probability of a change from which on the ground counts as changed [1].
constexpr double kChanged = 0.5;
/// Among stored surfaces a block expects a change this seldom [1].
constexpr double kSlowHazard = 0.05;

/// Whether they are, and of all there is: the sum is one but for rounding.
bool areProbabilities(const std::vector<double>& weights) {
  double total = 0.0;
  for (const double weight : weights) {
    if (!(weight >= 0.0)) return false;
    total += weight;
  }
  return std::abs(total - 1.0) < 1e-6;
}

/// The filter of one block: nothing changes in it.
FilterConfig blockConfig(FilterConfig config) {
  config.hazard = 0.0;
  config.drift = 0.0;
  config.steady = 1.0;
  config.caution = 1.0;
  return config;
}

}  // namespace

Bank::Bank(const RuleConfig& config, const PatternSet& shipped)
    : config_(config.bank),
      model_(std::make_shared<GroundModel>(config.filter, shipped)),
      filter_(model_, config.filter),
      block_filter_(model_, blockConfig(config.filter)),
      surfaces_(model_),
      weights_{1.0},
      mean_(Eigen::VectorXd::Zero(model_->dimension())) {
  const auto most = static_cast<size_t>(config_.capacity) + 1;
  weights_.reserve(most);
  known_.reserve(most);
  logs_.reserve(most);
  block_.reserve(static_cast<size_t>(config_.settled_after));
}

/// w, from the densities in logs_.
void Bank::weigh(double log_unknown) {
  const size_t known = surfaces_.size();
  logs_[0] = log_unknown;
  const double prior_known =
      known > 0 ? (1.0 - config_.unknown_prior) / static_cast<double>(known) : 0.0;
  double highest = -std::numeric_limits<double>::infinity();  // of those that are possible
  for (size_t k = 0; k <= known; ++k) {
    const double prior = k > 0 ? prior_known : (known > 0 ? config_.unknown_prior : 1.0);
    weights_[k] = (1.0 - config_.hazard) * weights_[k] + config_.hazard * prior;
    if (weights_[k] > 0.0) highest = std::max(highest, logs_[k]);
  }
  double total = 0.0;
  for (size_t k = 0; k <= known; ++k) {
    if (weights_[k] > 0.0) weights_[k] *= std::exp(logs_[k] - highest);
    total += weights_[k];
  }
  for (double& weight : weights_) weight /= total;
}

/// The same among stored surfaces, slowly; adds to the block's density.
void Bank::weighKnown() {
  if (known_.empty()) return;
  const double highest = *std::max_element(logs_.begin() + 1, logs_.end());
  const double prior = kSlowHazard / static_cast<double>(known_.size());
  double total = 0.0;
  for (size_t k = 0; k < known_.size(); ++k) {
    known_[k] = ((1.0 - kSlowHazard) * known_[k] + prior) * std::exp(logs_[k + 1] - highest);
    total += known_[k];
  }
  for (double& weight : known_) weight /= total;
  block_log_known_ += highest + std::log(total);
}

void Bank::addToBlock(const TwistSample& sample) {
  Entry entry{sample, 0};
  if (!known_.empty())
    entry.surface =
        1 + static_cast<size_t>(std::max_element(known_.begin(), known_.end()) - known_.begin());
  block_.push_back(entry);
}

void Bank::clearBlock() {
  block_.clear();
  block_log_known_ = 0.0;
}

double Bank::logDensityAsNew() {
  // Twice: the noise that the block shows itself decides how exactly it fits.
  logDensityAsNew(Eigen::Vector3d::Ones());
  Eigen::Vector3d seen = Eigen::Vector3d::Constant(SurfaceBank::kNoisePrior);
  for (const Entry& entry : block_) {
    const size_t p = entry.sample.pattern;
    const Eigen::Vector3d y =
        plausible(entry.sample.mean_twist) - model_->meanTwistUnder(block_filter_.mean(), p);
    seen += y.cwiseAbs2().cwiseQuotient(model_->noise(p).diagonal());
  }
  const Eigen::Vector3d noise =
      seen / (SurfaceBank::kNoisePrior + static_cast<double>(block_.size()));
  return logDensityAsNew(
      noise.cwiseMax(SurfaceBank::kLeastNoise).cwiseMin(SurfaceBank::kMostNoise));
}

double Bank::logDensityAsNew(const Eigen::Vector3d& noise) {
  block_filter_.restartAt(Eigen::VectorXd::Zero(model_->dimension()), 1.0);
  block_filter_.setNoise(noise);
  double log_density = 0.0;
  for (const Entry& entry : block_)
    log_density += block_filter_.update(entry.sample.pattern, entry.sample.mean_twist);
  return log_density;
}

void Bank::storeBlock(RuleNote& note) {
  RememberedSurface surface;
  surface.x = block_filter_.mean();
  surface.driven.assign(model_->patterns(), 0.0);
  for (const Entry& entry : block_) surface.driven[entry.sample.pattern] += 1.0;
  surface.noise = block_filter_.noise();
  surface.last_met = clock_;
  const size_t place = surfaces_.store(std::move(surface), static_cast<size_t>(config_.capacity));
  if (place == known_.size()) {
    known_.push_back(0.0);
    weights_.push_back(0.0);
  }
  // What was stored before in this place is forgotten; the new one has its weight, too.
  weights_[place + 1] += weights_[0];
  weights_[0] = 0.0;
  std::fill(known_.begin(), known_.end(), 0.0);
  known_[place] = 1.0;
  note.surface_stored = true;
}

void Bank::refineKnown() {
  for (size_t k = 0; k < surfaces_.size(); ++k) {
    std::vector<TwistSample> samples;
    for (const Entry& entry : block_)
      if (entry.surface == k + 1) samples.push_back(entry.sample);
    if (!samples.empty()) surfaces_.refine(k, samples, clock_);
  }
}

void Bank::closeBlock(RuleNote& note) {
  const double log_new = logDensityAsNew();
  if (known_.empty() || log_new > block_log_known_ + config_.new_margin) {
    storeBlock(note);
  } else {
    refineKnown();
  }
  clearBlock();
  // A block that proves to be a surface that is stored already is not a new one.
  if (mergeAlike()) note.surface_stored = false;
}

bool Bank::mergeAlike() {
  bool merged = false;
  for (size_t i = 0; i < surfaces_.size(); ++i) {
    for (size_t j = surfaces_.size() - 1; j > i; --j) {
      // Only what was met just now can have become alike.
      if (surfaces_[i].stored().last_met != clock_ && surfaces_[j].stored().last_met != clock_)
        continue;
      if (!surfaces_.alike(i, j)) continue;
      surfaces_.merge(i, j);
      merged = true;
      known_[i] += known_[j];
      weights_[i + 1] += weights_[j + 1];
      known_.erase(known_.begin() + static_cast<std::ptrdiff_t>(j));
      weights_.erase(weights_.begin() + static_cast<std::ptrdiff_t>(j) + 1);
    }
  }
  return merged;
}

void Bank::mix() {
  mean_ = weights_[0] * filter_.mean();
  for (size_t k = 0; k < surfaces_.size(); ++k) mean_ += weights_[k + 1] * surfaces_[k].mean();
}

void Bank::learn(size_t executed, const ConstTrajectory& measured, RuleNote& note) {
  const Eigen::Vector3d mean_twist = meanTwist(measured, model_->period());
  if (!mean_twist.allFinite()) return;  // beyond all numbers
  ++clock_;
  const TwistSample sample{executed, plausible(mean_twist)};
  logs_.resize(surfaces_.size() + 1);
  for (size_t k = 0; k < surfaces_.size(); ++k) logs_[k + 1] = surfaces_.logLikelihood(k, sample);
  weigh(filter_.update(executed, sample.mean_twist));
  note.change_probability = filter_.changeProbability();
  if (note.change_probability > kChanged) clearBlock();
  weighKnown();
  addToBlock(sample);
  // Who leaves a known surface for an unknown one leaves from there.
  for (size_t k = 0; k < surfaces_.size(); ++k)
    if (weights_[k + 1] > kSure) filter_.restartAt(surfaces_[k].mean(), 1.0);
  if (static_cast<int64_t>(block_.size()) >= config_.settled_after) closeBlock(note);
  mix();
  const auto likeliest = std::max_element(weights_.begin(), weights_.end());
  note.surface = static_cast<int>(likeliest - weights_.begin());
  note.surface_probability = *likeliest;
}

std::string Bank::reason(const RuleNote& note) const {
  const std::string sure = " (" + percent(note.surface_probability) + ")";
  if (note.surface_stored)
    return "remembered as surface " + std::to_string(note.surface) + " from now on";
  return note.surface > 0 ? "as surface " + std::to_string(note.surface) + sure
                          : "unknown ground" + sure;
}

void Bank::predict(size_t pattern, Trajectory prediction) const {
  model_->profile(pattern).integrate(model_->correctionOf(mean_, pattern), prediction);
}

Pose2 Bank::predictEnd(size_t pattern) const {
  return model_->profile(pattern).integrateEnd(model_->correctionOf(mean_, pattern));
}

std::optional<PoseCovariance> Bank::endCovariance(size_t pattern) const {
  const auto& J = model_->profile(pattern).endResponse();
  const Eigen::Matrix3d& lever = model_->profile(pattern).endLever();
  const Correction10 mean = model_->correctionOf(mean_, pattern);
  const auto away = [&](const Eigen::VectorXd& x) -> Eigen::Matrix3d {
    const Eigen::Vector3d moved = J * (model_->correctionOf(x, pattern) - mean);
    return moved * moved.transpose();
  };
  Eigen::Matrix<double, TwistCorrection::kAll, TwistCorrection::kAll> ground =
      weights_[0] * model_->covarianceOf(filter_.covariance(), pattern);
  Eigen::Matrix3d moved = weights_[0] * away(filter_.mean());
  Eigen::Matrix3d execution = Eigen::Matrix3d::Zero();
  for (size_t k = 0; k < surfaces_.size(); ++k) {
    const double weight = weights_[k + 1];
    ground += weight * model_->covarianceOf(surfaces_[k].covariance(), pattern);
    moved += weight * away(surfaces_[k].mean());
    execution += weight * surfaces_[k].executionNoise(*model_, pattern);
  }
  const Eigen::Matrix3d covariance = weights_[0] * model_->endNoise(pattern) + moved +
                                     lever * execution * lever.transpose() +
                                     J * ground * J.transpose();
  return upperTriangle(0.5 * (covariance + covariance.transpose()));
}

void Bank::assign(const LearningRule& other) {
  const auto& bank = static_cast<const Bank&>(other);
  filter_.assign(bank.filter_);
  surfaces_ = bank.surfaces_;
  weights_ = bank.weights_;
  known_ = bank.known_;
  block_ = bank.block_;
  block_log_known_ = bank.block_log_known_;
  clock_ = bank.clock_;
  mean_ = bank.mean_;
}

void Bank::adoptBank(const SurfaceBank& bank) {
  surfaces_ = bank;
  weights_.assign(surfaces_.size() + 1, 0.0);
  weights_[0] = 1.0;
  known_.assign(surfaces_.size(),
                1.0 / std::max<double>(1.0, static_cast<double>(surfaces_.size())));
  for (size_t k = 0; k < surfaces_.size(); ++k)
    clock_ = std::max(clock_, surfaces_[k].stored().last_met);
  clearBlock();
  mix();
}

// What the bank writes into the state file, and what it takes back from there.

std::vector<double> Bank::memory() const {
  std::vector<double> memory;
  filter_.save(memory);
  surfaces_.save(memory);
  memory.insert(memory.end(), weights_.begin(), weights_.end());
  memory.insert(memory.end(), known_.begin(), known_.end());
  memory.insert(memory.end(), {block_log_known_, static_cast<double>(clock_),
                               static_cast<double>(block_.size())});
  for (const Entry& entry : block_)
    memory.insert(memory.end(), {static_cast<double>(entry.sample.pattern),
                                 entry.sample.mean_twist[0], entry.sample.mean_twist[1],
                                 entry.sample.mean_twist[2], static_cast<double>(entry.surface)});
  return memory;
}

bool Bank::restore(const TrajectoryTable&, const std::vector<double>& memory) {
  for (const double number : memory)
    if (!std::isfinite(number)) return false;
  Bank bank = *this;
  size_t at = 0;
  if (!bank.filter_.restore(memory, at) || !bank.surfaces_.restore(memory, at)) return false;
  const size_t known = bank.surfaces_.size();
  if (memory.size() < at + 2 * known + 4) return false;
  bank.weights_.assign(known + 1, 0.0);
  for (double& weight : bank.weights_) weight = memory[at++];
  bank.known_.assign(known, 0.0);
  for (double& weight : bank.known_) weight = memory[at++];
  if (!areProbabilities(bank.weights_) || (known > 0 && !areProbabilities(bank.known_)))
    return false;
  bank.block_log_known_ = memory[at++];
  if (!isCount(memory[at], kMostExecutions)) return false;
  bank.clock_ = static_cast<int64_t>(memory[at++]);
  if (bank.surfaces_.newest() > bank.clock_ || !bank.restoreBlock(memory, at)) return false;
  assign(bank);
  mix();
  return true;
}

bool Bank::restoreBlock(const std::vector<double>& memory, size_t at) {
  constexpr size_t kEach = 5;
  const size_t numbers = memory.size() - at - 1;
  if (memory[at++] * kEach != static_cast<double>(numbers) || numbers % kEach != 0) return false;
  const double patterns = static_cast<double>(model_->patterns()) - 1.0;
  block_.clear();
  for (; at < memory.size(); at += kEach) {
    if (!isCount(memory[at], patterns)) return false;
    if (!isCount(memory[at + 4], static_cast<double>(known_.size()))) return false;
    block_.push_back(
        {{static_cast<size_t>(memory[at]), {memory[at + 1], memory[at + 2], memory[at + 3]}},
         static_cast<size_t>(memory[at + 4])});
  }
  return true;
}

}  // namespace tread::learner
