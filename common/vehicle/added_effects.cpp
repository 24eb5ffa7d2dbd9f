// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/vehicle/added_effects.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/vehicle/kernel.hpp"

namespace tread {
namespace {

constexpr std::array<const char*, 3> kOfTrack{"speed", "other", "side"};
constexpr std::array<const char*, 4> kOfMotion{"left", "right", "moving", "v_y"};
constexpr std::array<const char*, 5> kOfContext{"gauge", "session_time", "battery_drop", "roll",
                                                "pitch"};

std::vector<std::string> trackQuantities() {
  std::vector<std::string> all(kOfTrack.begin(), kOfTrack.end());
  all.insert(all.end(), kOfContext.begin(), kOfContext.end());
  return all;
}

std::vector<std::string> motionQuantities() {
  std::vector<std::string> all;
  for (const TermInput& input : kTermInputs) all.emplace_back(input.name);
  all.insert(all.end(), kOfMotion.begin(), kOfMotion.end());
  all.insert(all.end(), kOfContext.begin(), kOfContext.end());
  return all;
}

}  // namespace

const std::vector<std::string>& lawTargetNames() {
  static const std::vector<std::string> names{"track", "yaw_rate", "v", "v_y"};
  return names;
}

const std::vector<std::string>& quantitiesOf(LawTarget target) {
  static const std::vector<std::string> of_track = trackQuantities();
  static const std::vector<std::string> of_motion = motionQuantities();
  return target == LawTarget::kTrack ? of_track : of_motion;
}

AddedEffects::Acting::Acting(const AddedLaw& law, const std::vector<double>& parameters)
    : changes_(law.changes),
      formula_(law.formula),
      memory_place_(quantitiesOf(law.changes).size() + parameters.size()) {
  if (law.follows != nullptr) {
    follows_.emplace(law.follows);
    over_.emplace(law.over);
  }
  size_t place = quantitiesOf(changes_).size();
  for (const double parameter : parameters) set(place++, parameter);
}

void AddedEffects::Acting::set(size_t place, double value) const {
  formula_.input(place) = value;
  if (!follows_) return;
  follows_->input(place) = value;
  over_->input(place) = value;
}

double AddedEffects::Acting::change(double value, size_t memory, double dt) {
  if (follows_) {
    set(memory_place_, memories[memory]);
    const double target = follows_->value();
    const double over = over_->value();
    Followed now{memories[memory], memories[memory]};
    if (std::isfinite(target) && (over <= 0.0 || dt > 0.0)) now = follow(now.end, target, over, dt);
    if (dt > 0.0 && std::isfinite(now.end)) memories[memory] = now.end;
    formula_.input(memory_place_) = now.mean;
  }
  const double change = formula_.value() - value;
  return std::isfinite(change) ? std::clamp(change, -kLargestTermValue, kLargestTermValue) : 0.0;
}

void AddedEffects::Acting::settle(size_t memory) {
  if (!follows_) return;
  set(memory_place_, 0.0);
  const double target = follows_->value();
  memories[memory] = std::isfinite(target) ? target : 0.0;
}

AddedEffects::AddedEffects(const EffectValues& values) {
  if (values.added == EffectValues().added) return;
  for (const Effect& effect : effectCatalogue()) {
    if (effect.law == nullptr || !isOn(effect, values, {})) continue;
    std::vector<double> parameters;
    for (const EffectParameter& parameter : effect.parameters)
      parameters.push_back(valueIn(values, parameter));
    (effect.law->changes == LawTarget::kTrack ? tracks_ : motion_)
        .emplace_back(*effect.law, parameters);
  }
}

void AddedEffects::setTrack(const Acting& acting, const TrackCommand& asked, double side,
                            double gauge, const DriveContext& context) {
  const bool left = side > 0.0;
  size_t place = 0;
  for (const double value :
       {left ? asked.left : asked.right, left ? asked.right : asked.left, side, gauge,
        context.session_time, context.battery_drop, context.roll, context.pitch})
    acting.set(place++, value);
}

void AddedEffects::setMotion(const Acting& acting, const LawInputs& inputs, double v_y) {
  size_t place = 0;
  for (const TermInput& input : kTermInputs) acting.set(place++, inputs.motion.*input.value);
  const DriveContext& context = inputs.context;
  for (const double value :
       {inputs.tracks.left, inputs.tracks.right, inputs.moving, v_y, inputs.gauge,
        context.session_time, context.battery_drop, context.roll, context.pitch})
    acting.set(place++, value);
}

TrackCommand AddedEffects::tracks(const TrackCommand& asked, double gauge,
                                  const DriveContext& context, double dt) {
  TrackCommand changed = asked;
  for (Acting& acting : tracks_) {
    setTrack(acting, asked, 1.0, gauge, context);
    changed.left += acting.change(asked.left, 0, dt);
    setTrack(acting, asked, -1.0, gauge, context);
    changed.right += acting.change(asked.right, 1, dt);
  }
  return changed;
}

Twist2 AddedEffects::changes(const LawInputs& inputs, const Twist2& v_body, double dt) {
  Twist2 change;
  for (Acting& acting : motion_) {
    setMotion(acting, inputs, v_body.v_y);
    if (acting.changes() == LawTarget::kSpeed) change.v_x += acting.change(v_body.v_x, 0, dt);
    if (acting.changes() == LawTarget::kYawRate) change.omega += acting.change(v_body.omega, 0, dt);
    if (acting.changes() == LawTarget::kSideways) change.v_y += acting.change(v_body.v_y, 0, dt);
  }
  return change;
}

void AddedEffects::settleTracks(const TrackCommand& asked, double gauge,
                                const DriveContext& context) {
  for (Acting& acting : tracks_) {
    setTrack(acting, asked, 1.0, gauge, context);
    acting.settle(0);
    setTrack(acting, asked, -1.0, gauge, context);
    acting.settle(1);
  }
}

void AddedEffects::settleMotion(const LawInputs& inputs, const Twist2& v_body) {
  for (Acting& acting : motion_) {
    setMotion(acting, inputs, v_body.v_y);
    acting.settle(0);
  }
}

AddedMemory AddedEffects::memory() const {
  AddedMemory all;
  for (const std::vector<Acting>* some : {&tracks_, &motion_})
    for (const Acting& acting : *some)
      all.insert(all.end(), acting.memories.begin(), acting.memories.end());
  return all;
}

void AddedEffects::remember(const AddedMemory& memory) {
  if (memory.size() != 2 * (tracks_.size() + motion_.size())) return;
  auto next = memory.begin();
  for (std::vector<Acting>* some : {&tracks_, &motion_})
    for (Acting& acting : *some)
      for (double& one : acting.memories) one = *next++;
}

}  // namespace tread
