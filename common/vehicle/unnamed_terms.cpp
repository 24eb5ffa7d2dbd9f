// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/vehicle/unnamed_terms.hpp"

#include <algorithm>
#include <cmath>

namespace tread {
namespace {

double signOf(double value) {
  return std::tanh(value / kSignWidth);
}

/// A first-order memory that follows `now` over dt: returns its mean; the memory ends at its final
/// value.
double followMemory(double now, double dt, double& memory) {
  const double decay = std::exp(-dt / kTermMemory);
  const double distance = memory - now;
  memory = now + distance * decay;
  return dt > 0.0 ? now + distance * (1.0 - decay) * kTermMemory / dt : memory;
}

}  // namespace

const std::vector<TermCondition>& termConditions() {
  static const std::vector<TermCondition> all{
      {"v", "m/s", [](const TermInputs& m) { return m.v; }, "v"},
      {"yaw rate", "rad/s", [](const TermInputs& m) { return m.omega; }, "yaw_rate"},
      {"|v|", "m/s", [](const TermInputs& m) { return std::abs(m.v); }, "abs(v)"},
      {"|yaw rate|", "rad/s", [](const TermInputs& m) { return std::abs(m.omega); },
       "abs(yaw_rate)"},
      {"change of v", "m/s2", [](const TermInputs& m) { return m.v_change; }, "v_change"},
      {"change of yaw rate", "rad/s2", [](const TermInputs& m) { return m.omega_change; },
       "yaw_rate_change"},
      {"change of |v|", "m/s2", [](const TermInputs& m) { return signOf(m.v) * m.v_change; },
       "smooth_sign(v) * v_change"},
      {"change of |yaw rate|", "rad/s2",
       [](const TermInputs& m) { return signOf(m.omega) * m.omega_change; },
       "smooth_sign(yaw_rate) * yaw_rate_change"},
      {"turns before", "1", [](const TermInputs& m) { return m.turned; }, "turns_before"},
      {"forward command", "m/s", [](const TermInputs& m) { return m.forward; }, "forward_command"},
      {"turning command", "m/s", [](const TermInputs& m) { return m.turning; }, "turning_command"},
      {"sign of v", "1", [](const TermInputs& m) { return signOf(m.v); }, "smooth_sign(v)"},
      {"sign of yaw rate", "1", [](const TermInputs& m) { return signOf(m.omega); },
       "smooth_sign(yaw_rate)"}};
  return all;
}

const TermCondition* findTermCondition(const std::string& name) {
  for (const TermCondition& condition : termConditions())
    if (name == condition.name) return &condition;
  return nullptr;
}

const char* termChannelName(TermChannel channel) {
  static constexpr const char* kNames[] = {"yaw rate", "v", "v_y"};
  return kNames[static_cast<size_t>(channel)];
}

const char* termChannelUnit(TermChannel channel) {
  return channel == TermChannel::kYawRate ? "rad/s" : "m/s";
}

double UnnamedTerm::factor(const TermInputs& inputs) const {
  return times == nullptr ? 1.0 : std::clamp(times->value(inputs), times_low, times_high);
}

std::pair<size_t, double> placeOnCurve(const std::vector<double>& at, double condition) {
  const auto above = std::upper_bound(at.begin() + 1, at.end() - 1, condition);
  const auto upper = static_cast<size_t>(std::distance(at.begin(), above));
  const double share = (condition - at[upper - 1]) / (at[upper] - at[upper - 1]);
  return {upper - 1, std::clamp(share, 0.0, 1.0)};
}

double UnnamedTerm::curve(double condition_value) const {
  const auto [lower, share] = placeOnCurve(at, condition_value);
  return values[lower] + share * (values[lower + 1] - values[lower]);
}

Twist2 twistOf(const std::vector<UnnamedTerm>& terms, const TermInputs& inputs) {
  Twist2 sum{0.0, 0.0, 0.0};
  for (const UnnamedTerm& term : terms) {
    const double value = term.value(inputs);
    if (term.channel == TermChannel::kYawRate) sum.omega += value;
    if (term.channel == TermChannel::kSpeed) sum.v_x += value;
    if (term.channel == TermChannel::kSideways) sum.v_y += value;
  }
  return sum;
}

TermInputs remember(double v, double omega, double dt, TermMemory& memory) {
  TermInputs inputs;
  inputs.v = v;
  inputs.omega = omega;
  inputs.v_change = (v - followMemory(v, dt, memory.v)) / kTermMemory;
  inputs.omega_change = (omega - followMemory(omega, dt, memory.omega)) / kTermMemory;
  inputs.turned = memory.turned;
  const double turned = omega * dt;
  const double decay = std::exp(-std::abs(turned) / kTurnsMemory);
  memory.turned = memory.turned * decay + std::copysign(1.0 - decay, turned);
  return inputs;
}

TermInputs inputsNow(double v, double omega, const TermMemory& memory) {
  TermMemory unchanged = memory;
  return remember(v, omega, 0.0, unchanged);
}

}  // namespace tread
