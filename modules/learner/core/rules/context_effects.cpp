// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/rules/context_effects.hpp"

#include <algorithm>
#include <cmath>

#include "modules/learner/core/rules/surface.hpp"

namespace tread::learner {
namespace {

/// Executions on a ground before its mean context is usable.
constexpr double kLeastExecutions = 3.0;
/// Executions after which older ones fade in the mean context, as in that of the ground.
constexpr double kMemory = 30.0;
/// Share of older evidence that remains after an execution.
constexpr double kEvidenceKept = 0.99;
/// Limit of the evidence, so that a repair of the vehicle is detected in time.
constexpr double kMostEvidence = 20.0;
/// A deviation of more standard deviations means other ground.
constexpr double kMostSigmas = 4.0;
/// Upper limit of the effect of slope or battery [1], as a share of a velocity.
constexpr double kMostEffect = 0.5;

double logNormal(double y, double variance) {
  return -0.5 * (y * y / variance + std::log(variance));
}

}  // namespace

ContextEffects::ContextEffects(const GroundConfig& config) : evidence_(config.context_evidence) {
  variance_.col(kSlope).setConstant(config.slope_effect * config.slope_effect);
  variance_.col(kVoltage).setConstant(config.voltage_effect * config.voltage_effect);
}

void ContextEffects::meet(double voltage) {
  if (!(voltage > 0.0 && std::isfinite(voltage))) return;
  if (first_voltage_ == 0.0) first_voltage_ = voltage;
  sag_ = std::clamp(voltage / first_voltage_ - 1.0, -kMostEffect, kMostEffect);
}

ContextEffects::Inputs ContextEffects::inputs(const PatternPart& part, double seconds,
                                              const Tilt& tilt) const {
  Inputs f = Inputs::Zero();
  if (std::isfinite(tilt.ahead) && std::isfinite(tilt.left)) {
    const double speed = part.metres / seconds;
    f.col(kSlope) << speed * tilt.ahead, speed * tilt.left, speed * tilt.left;
  }
  f(0, kVoltage) = part.mean[0] * sag_;
  f(2, kVoltage) = part.mean[2] * sag_;
  return f;
}

Eigen::Vector3d ContextEffects::effect(const Inputs& f) const {
  return counts_.cwiseProduct(c_).cwiseProduct(f).rowwise().sum();
}

Eigen::Vector2d ContextEffects::gainsNow() const {
  const auto gain = [&](Eigen::Index velocity) {
    return std::clamp(counts_(velocity, kVoltage) * c_(velocity, kVoltage) * sag_, -kMostEffect,
                      kMostEffect);
  };
  return {gain(0), gain(2)};
}

void ContextEffects::learn(const Inputs& f, const Eigen::Vector3d& beyond,
                           const Eigen::Vector3d& variance, int64_t ground) {
  if (ground != ground_) {
    ground_ = ground;
    executions_ = 0.0;
  }
  const Inputs g = f - mean_;
  if (executions_ >= kLeastExecutions) {
    // The ground includes the constant part of an effect: the rest varies with g.
    const Inputs counted = counts_.cwiseProduct(c_).cwiseProduct(g);
    forEach([&](Eigen::Index i, Eigen::Index k) {
      const double y = beyond[i] + counted(i, k);
      const double expected = c_(i, k) * g(i, k);
      const double spread = variance[i] + g(i, k) * g(i, k) * variance_(i, k);
      if (std::abs(y - expected) > kMostSigmas * std::sqrt(spread)) return;
      gained_(i, k) = std::clamp(kEvidenceKept * gained_(i, k) + logNormal(y - expected, spread) -
                                     logNormal(y, variance[i]),
                                 -kMostEvidence, kMostEvidence);
      const double gain = g(i, k) * variance_(i, k) / spread;
      c_(i, k) += gain * (y - expected);
      variance_(i, k) *= variance[i] / spread;
    });
    forEach([&](Eigen::Index i, Eigen::Index k) {
      if (gained_(i, k) > evidence_) counts_(i, k) = 1.0;
      if (gained_(i, k) < 0.0) counts_(i, k) = 0.0;
    });
  }
  executions_ = std::min(executions_ + 1.0, kMemory);
  if (executions_ == 1.0) mean_ = f;
  mean_ += (f - mean_) / executions_;
}

void ContextEffects::save(std::vector<double>& memory) const {
  for (const Inputs* numbers : {&c_, &variance_, &gained_, &counts_, &mean_})
    memory.insert(memory.end(), numbers->data(), numbers->data() + numbers->size());
  memory.insert(memory.end(),
                {executions_, static_cast<double>(ground_ + 1), first_voltage_, sag_});
}

bool ContextEffects::restore(const std::vector<double>& memory, size_t& at) {
  constexpr double kMostVoltage = 1e5;
  constexpr double kMostInput = 1e3;
  if (memory.size() < at + 5 * static_cast<size_t>(c_.size()) + 4) return false;
  for (Inputs* numbers : {&c_, &variance_, &gained_, &counts_, &mean_})
    for (double& number : numbers->reshaped()) number = memory[at++];
  executions_ = memory[at];
  if (!isCount(memory[at + 1], kMostExecutions)) return false;
  ground_ = static_cast<int64_t>(memory[at + 1]) - 1;
  first_voltage_ = memory[at + 2];
  sag_ = memory[at + 3];
  at += 4;
  const bool flags = (counts_.array() == 0.0 || counts_.array() == 1.0).all();
  return flags && c_.cwiseAbs().maxCoeff() <= kMostInput && variance_.minCoeff() > 0.0 &&
         variance_.maxCoeff() <= kMostInput && gained_.cwiseAbs().maxCoeff() <= kMostEvidence &&
         mean_.cwiseAbs().maxCoeff() <= kMostInput && executions_ >= 0.0 &&
         executions_ <= kMemory && first_voltage_ >= 0.0 && first_voltage_ <= kMostVoltage &&
         std::abs(sag_) <= kMostEffect;
}

}  // namespace tread::learner
