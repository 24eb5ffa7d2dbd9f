// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/report/headline.hpp"

#include <algorithm>
#include <map>

#include "common/vehicle/degeneracy.hpp"
#include "tools/gap/report/pictures.hpp"
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
    {"slip_ratio", "Both tracks carry the vehicle further than they turn, by the same share"},
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

/// Effects of the model that are other ones now.
std::vector<std::string> movedIn(const Finding& finding) {
  std::vector<std::string> names;
  for (const Estimate& estimate : finding.calibrated) {
    const std::string effect = estimate.parameter.substr(0, estimate.parameter.find('.'));
    if (estimate.moved && std::find(names.begin(), names.end(), effect) == names.end())
      names.push_back(effect);
  }
  return names;
}

/// Found effects; where there are none, those that have changed.
std::vector<std::string> namesOf(const Finding& finding) {
  std::vector<std::string> names;
  names.reserve(finding.effects.size());
  for (const FoundEffect& effect : finding.effects)
    if (isShown(effect)) names.push_back(effect.name);
  return names.empty() ? movedIn(finding) : names;
}

std::string movedSentence(const Estimate& estimate) {
  const std::string effect = estimate.parameter.substr(0, estimate.parameter.find('.'));
  return shortTitleOf(effect) +
         ", which the model has, is another one now: " + saidEstimate(estimate) + " instead of " +
         threeDigits(estimate.before) + " " + estimate.unit + ".";
}

/// Effects that this drive cannot tell from a found one, itself first.
std::vector<std::string> alternativesOf(const FoundEffect& effect) {
  std::vector<std::string> names{effect.name};
  names.insert(names.end(), effect.group.begin(), effect.group.end());
  for (const RunnerUp& runner_up : effect.runner_ups)
    if (runner_up.behind <= runner_up.error &&
        std::find(names.begin(), names.end(), runner_up.effect) == names.end())
      names.push_back(runner_up.effect);
  return names;
}

std::string ambiguousHeadline(const Finding& finding) {
  std::vector<std::string> parts;
  for (const FoundEffect& effect : finding.effects) {
    if (!isShown(effect)) continue;
    const std::vector<std::string> names = alternativesOf(effect);
    parts.push_back(shortTitlesOf(names, "or"));
  }
  return joined(parts, "and") + ": this drive cannot tell them apart";
}

/// The measurement or drive that tells the members of a group apart, from the degeneracy table.
std::vector<std::string> waysToTell(const FoundEffect& effect) {
  std::vector<std::string> ways;
  for (const DegeneracyGroup* group : groupsOf(effect.name)) {
    const bool met =
        std::any_of(group->members.begin(), group->members.end(), [&](const std::string& member) {
          const std::vector<std::string> names = alternativesOf(effect);
          return member != effect.name &&
                 std::find(names.begin(), names.end(), member) != names.end();
        });
    if (met) ways.push_back(group->separates);
  }
  if (ways.empty()) ways.push_back(effectNamed(effect.name).separates);
  return ways;
}

void addNext(const Finding& finding, std::vector<Block>& blocks) {
  Points points;
  if (finding.verdict == Verdict::kAmbiguous)
    for (const FoundEffect& effect : finding.effects)
      for (const std::string& way : waysToTell(effect)) points.items.push_back("To tell: " + way);
  if (finding.verdict == Verdict::kFound || finding.verdict == Verdict::kMeasurement ||
      finding.verdict == Verdict::kPartial)
    for (const FoundEffect& effect : finding.effects)
      points.items.push_back("To check " + inSentence(shortTitleOf(effect.name)) +
                             " in two minutes: " + effectNamed(effect.name).check);
  if (finding.verdict == Verdict::kCannotTell && !finding.not_excited.empty())
    points.items.push_back("This drive would not have shown: " + titlesOf(finding.not_excited) +
                           ".");
  if (!points.items.empty()) blocks.push_back(points);
}

std::string opening(const Finding& finding) {
  switch (finding.verdict) {
    case Verdict::kNoDiscrepancy:
      return std::string(
                 "What the model predicts and what the INS measured differ by no more than chance, "
                 "over the whole catalogue and on all variables. Which effects would have been "
                 "seen, "
                 "from which size on, stands below.") +
             (finding.negligible.empty()
                  ? std::string()
                  : " Real, but too small to matter: " + titlesOf(finding.negligible) + ".");
    case Verdict::kNotInCatalogue:
      return "There is a disagreement, and no effect of the catalogue explains it. A term by "
             "another name would be a guess; the model stays as it was but for its calibration.";
    case Verdict::kCannotTell:
      return finding.reason + (finding.reason.empty() || finding.reason.back() == '.' ? "" : ".");
    case Verdict::kMeasurement:
      return "The vehicle drives as the model says; what differs is how the INS reports it. Only "
             "the measurement part of the model has changed.";
    default:
      return "";
  }
}

std::string saidErrors(const EndErrors& errors, bool rms) {
  return saidDistance(rms ? errors.position.rms : errors.position.median) + " and " +
         saidAngle(rms ? errors.yaw.rms : errors.yaw.median);
}

}  // namespace

std::string headlineOf(const Finding& finding) {
  const std::string names = shortTitlesOf(namesOf(finding));
  switch (finding.verdict) {
    case Verdict::kNoDiscrepancy:
      return "Simulation and measurement agree";
    case Verdict::kFound:
      return "Found: " + names;
    case Verdict::kAmbiguous:
      return ambiguousHeadline(finding);
    case Verdict::kPartial:
      return "Found: " + names + "; and something more without a name";
    case Verdict::kNotInCatalogue:
      return "Something that is not in the catalogue";
    case Verdict::kMeasurement:
      return "The INS, not the vehicle: " + names;
    case Verdict::kCannotTell:
      return "This drive cannot tell";
  }
  return "";
}

std::string sentenceOf(const FoundEffect& effect) {
  std::vector<std::string> numbers;
  std::string direction;
  for (const Estimate& estimate : effect.parameters) {
    numbers.push_back(saidEstimate(estimate));
    if (direction.empty()) direction = directionOf(estimate);
  }
  std::string text = plainSentence(effect);
  if (!numbers.empty()) text += ": " + joined(numbers);
  if (!direction.empty()) text += "; " + direction;
  if (effect.accepted)
    text += isShown(effect) ? " (accepted; the drive shows it, too)"
                            : " (accepted; the drive alone does not show it: p " +
                                  saidChance(effect.p_value) + ")";
  return text + ".";
}

std::vector<std::string> movedSentences(const Finding& finding) {
  std::vector<std::string> sentences;
  for (const Estimate& estimate : finding.calibrated)
    if (estimate.moved) sentences.push_back(movedSentence(estimate));
  return sentences;
}

std::string gainOf(const Gap& gap) {
  std::string text =
      threeDigits(gap.horizon) +
      " s end-pose error on driving it has not seen: " + threeDigits(gap.before.position.median) +
      " -> " + saidDistance(gap.after.position.median) + ", heading " +
      threeDigits(gap.before.yaw.median * 180.0 / kPi) + " -> " + saidAngle(gap.after.yaw.median) +
      " (median of " + std::to_string(gap.after.executions) + " executions; rms " +
      saidErrors(gap.before, true) + " -> " + saidErrors(gap.after, true) + ").";
  if (gap.floor)
    text += " Dead reckoning with encoders and gyro, about the best that is possible, reaches " +
            saidErrors(*gap.floor, false) + ".";
  if (!gap.structure_nested)
    text +=
        " The parameters were fitted without these executions, the effects were chosen with "
        "them.";
  return text;
}

std::string remainsOf(const std::vector<Unexplained>& rests) {
  std::vector<std::string> channels;
  std::map<std::string, std::vector<std::string>> variables;
  for (const Unexplained& rest : rests) {
    if (variables.count(rest.channel) == 0) channels.push_back(rest.channel);
    variables[rest.channel].push_back(rest.variable);
  }
  std::string text;
  for (const std::string& channel : channels)
    text += (text.empty() ? "" : "; ") + std::string("the ") + channel + " residual depends on " +
            joined(variables[channel]);
  return text;
}

std::vector<Block> firstBlocks(const Finding& finding) {
  std::vector<Block> blocks;
  const std::string words = opening(finding);
  if (!words.empty()) blocks.push_back(Paragraph{words});
  for (const FoundEffect& effect : finding.effects) blocks.push_back(Paragraph{sentenceOf(effect)});
  for (const std::string& sentence : movedSentences(finding)) blocks.push_back(Paragraph{sentence});
  if (!finding.unexplained.empty()) {
    blocks.push_back(Paragraph{"Unexplained: " + remainsOf(finding.unexplained) + "."});
  }
  if (finding.gap) {
    blocks.push_back(Paragraph{gainOf(*finding.gap)});
    blocks.push_back(Pictures{{gapPicture(*finding.gap, false), gapPicture(*finding.gap, true)},
                              "End errors on executions that were not used for the fit."});
  }
  addNext(finding, blocks);
  return blocks;
}

std::string moodOf(Verdict verdict) {
  if (verdict == Verdict::kNoDiscrepancy) return "good";
  if (verdict == Verdict::kFound || verdict == Verdict::kMeasurement) return "change";
  return "doubt";
}

}  // namespace tread::gap
