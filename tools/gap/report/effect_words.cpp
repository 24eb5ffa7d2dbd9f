// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/report/effect_words.hpp"

#include <algorithm>
#include <string>

#include "tools/gap/report/words.hpp"

namespace tread::gap {
namespace {

/// What the sign of a parameter means on the ground, where the effect's sentence leaves that open.
struct Direction {
  const char* path;
  const char* positive;
  const char* negative;
};

const Direction kDirections[] = {
    {"track_asymmetry.share", "the left track is the faster one",
     "the right track is the faster one"},
    {"yaw_pull.pull", "it pulls to the left", "it pulls to the right"},
    {"yaw_rate_offset.rate", "it turns to the left", "it turns to the right"},
    {"gyro_bias.rate", "a turn to the left", "a turn to the right"},
    {"icr_offset.offset", "ahead of the middle", "behind the middle"},
    {"reverse_yaw_gain.gain", "it turns more forwards", "it turns more backwards"},
    {"reverse_speed_gain.gain", "it is faster forwards", "it is faster backwards"},
    {"crab.angle", "it drifts to the left", "it drifts to the right"},
    {"heading_misalignment.angle", "its heading points too far to the right",
     "its heading points too far to the left"},
    {"lag_asymmetry.slowing", "braking takes longer", "braking is quicker"},
    {"payload_change.yaw", "it turns more than before", "it turns less than before"},
    {"terrain_change.width_1", "it turns less than before", "it turns more than before"},
    {"position_scale.scale", "too long", "too short"},
};

/// Effects whose sentence is wrong where their first parameter is negative, and what is right then.
const char* const kReversed[][2] = {
    {"slip_ratio",
     "Both tracks carry the vehicle further than they turn, by the same share, which is no slip "
     "(check the wheel radius)"},
    {"track_width", "The vehicle turns as if its tracks were closer together than they are"},
    {"yaw_rate_skid", "The faster it turns, the further it turns beyond what its tracks ask"},
    {"speed_understeer", "The same difference of the tracks turns more the faster it drives"},
    {"turn_speed_loss", "In turns it is faster than its tracks"},
    {"quadratic_drag", "The faster it drives, the further it runs ahead of its tracks"},
    {"centrifugal_drift", "In curves it is carried inwards, more the faster and tighter"},
    {"command_delay", "A command acts earlier than the model says"},
    {"actuator_lag", "The tracks take up a new speed sooner than the model says"},
    {"battery_sag", "The tracks get faster with time"},
    {"slope_pitch", "It is faster uphill and slower downhill"},
    {"slope_roll", "Driving across a slope it climbs"},
    {"ins_latency", "The stamps of the INS are early: its poses belong to later moments"},
    {"heading_latency", "The position of a pose is older than its heading"},
    {"lever_arm_x", "The INS reports a point that is so far ahead of the vehicle's middle"},
    {"lever_arm_y", "The INS reports a point that is so far to the left of the vehicle's middle"},
};

std::string plainSentence(const FoundEffect& effect) {
  const bool reversed = !effect.parameters.empty() && effect.parameters.front().value < 0.0;
  for (const auto& entry : kReversed)
    if (reversed && effect.name == entry[0]) return entry[1];
  return withoutStop(effectNamed(effect.name).sentence);
}

std::string directionOf(const Estimate& estimate) {
  for (const Direction& direction : kDirections)
    if (estimate.parameter == direction.path)
      return estimate.value < 0.0 ? direction.negative : direction.positive;
  return "";
}

std::string movedSentence(const Estimate& estimate) {
  const Estimate natural = naturalEstimate(estimate);
  if (estimate.parameter.find('.') == std::string::npos)
    return "A number of the model is another one now: " + saidEstimate(estimate) + " instead of " +
           said(natural.before, saidUnit(natural)) + "; " +
           inSentence(shortTitleOf(effectOf(estimate))) + " would do the same.";
  return shortTitleOf(effectOf(estimate)) +
         ", which the model has, is another one now: " + saidEstimate(estimate) + " instead of " +
         said(natural.before, saidUnit(natural)) + ".";
}

std::string withNumbers(const FoundEffect& effect, const std::vector<std::string>& totals) {
  std::vector<std::string> numbers;
  std::string direction;
  for (const Estimate& estimate : effect.parameters) {
    numbers.push_back(saidEstimate(estimate));
    if (direction.empty()) direction = directionOf(estimate);
  }
  std::string text = plainSentence(effect);
  if (!numbers.empty()) text += ": " + joined(numbers);
  if (!direction.empty()) text += "; " + direction;
  for (const std::string& total : totals) text += "; " + total;
  if (effect.accepted)
    text += isShown(effect) ? " (accepted; the drive shows it, too)"
                            : " (accepted; the drive alone does not show it: p " +
                                  saidChance(effect.p_value) + ")";
  return text + ".";
}

}  // namespace

std::string sentenceOf(const FoundEffect& effect) {
  return withNumbers(effect, {});
}

std::string sentenceOf(const FoundEffect& effect, const ModelDocument& model) {
  std::vector<std::string> totals;
  for (const Estimate& estimate : effect.parameters)
    if (const auto total = totalOf(estimate.parameter, model))
      totals.push_back(total->name + " " + said(total->value, total->unit));
  return withNumbers(effect, totals);
}

std::string titledSentenceOf(const FoundEffect& effect, const ModelDocument& model) {
  return shortTitleOf(effect.name) + ": " + inSentence(sentenceOf(effect, model));
}

std::optional<Total> totalOf(const std::string& path, const ModelDocument& model) {
  const VehicleModel& vehicle = model.vehicle;
  if (path == "command_delay.delay" && vehicle.delay != 0.0)
    return Total{"delay in all", vehicle.commandDelay(), "s"};
  if (path == "actuator_lag.lag" && vehicle.lag != 0.0)
    return Total{"lag in all", vehicle.driveLag(), "s"};
  if (path == "lag_asymmetry.slowing")
    return Total{"lag while slowing",
                 std::max(0.0, vehicle.driveLag() + vehicle.effects.lag_asymmetry), "s"};
  if (path == "track_width.widening")
    return Total{"effective width",
                 vehicle.gauge * (1.0 + vehicle.effects.track_width) / vehicle.yaw_gain, "m"};
  if (path == "slip_ratio.slip" && vehicle.forward_gain != 1.0)
    return Total{"speed over that of the tracks",
                 vehicle.forward_gain * (1.0 - vehicle.effects.slip_ratio), "1"};
  return std::nullopt;
}

std::string checkOf(const FoundEffect& effect) {
  const std::string check = effectNamed(effect.name).check;
  const bool negative = !effect.parameters.empty() && effect.parameters.front().value < 0.0;
  if (effect.name != "slip_ratio" || !negative) return check;
  const double share = -effect.parameters.front().value;
  return "No track slips forwards: check the wheel radius (or sprocket radius, or command gain) "
         "that "
         "the track speeds were made with; it may be too small by " +
         said(share, "1") + ". " + check;
}

std::vector<std::string> movedSentences(const Finding& finding) {
  std::vector<std::string> sentences;
  for (const Estimate& estimate : finding.calibrated)
    if (estimate.moved) sentences.push_back(movedSentence(estimate));
  return sentences;
}

}  // namespace tread::gap
