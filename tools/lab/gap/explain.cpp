// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/gap/explain.hpp"

#include "tools/lab/gap/report/report.hpp"

#include <algorithm>

#include "common/config/scalars.hpp"
#include "common/report/text.hpp"
#include "tools/lab/gap/report/words.hpp"

namespace tread::gap {
namespace {

const std::vector<Advice>& advices() {
  static const std::vector<Advice> all{
      {GapVerdict::kNoDiscrepancy,
       "nothing significant; the report gives the size from which each effect would have been seen",
       "Keep the model (after --calibrate: use model.yaml). To look deeper, drive longer, or drive "
       "what "
       "this drive lacked."},
      {GapVerdict::kNothingNew,
       "the log differs from the model exactly as the drive did from which the model was made, and "
       "in "
       "nothing else",
       "Keep the model; the vehicle is unchanged. What the model does not explain is recorded in "
       "its "
       "file as `rest`."},
      {GapVerdict::kFound, "named effects with sizes and intervals; the new model contains them",
       "Check each in two minutes, as the report says; run find with --test and a log of another "
       "day; then use model.yaml."},
      {GapVerdict::kAmbiguous,
       "it is one of several effects that this drive cannot tell apart; the report says what can",
       "The new model predicts the drive equally well with each. To decide, measure or drive what "
       "the report says, and give find both logs."},
      {GapVerdict::kPartial, "effects were found, and the residuals still depend on something",
       "Use model.yaml if its error is small enough for you. Else look at the curve of the "
       "unexplained part, drive more of that, and give find both logs."},
      {GapVerdict::kNotInCatalogue,
       "there is a disagreement that no effect of the catalogue explains; what it depends on is "
       "said",
       "Do not trust the model where the residuals depend on something. Look at the vehicle: loose "
       "tracks, load, tyres, other software; drive more of the named condition."},
      {GapVerdict::kMeasurement,
       "the INS differs, not the vehicle; only the measurement part of the model changes",
       "Correct the INS: lever arm, mounting, time stamps. Or keep the measurement part of "
       "model.yaml."},
      {GapVerdict::kCannotTell,
       "too little driving, an unsound log, or a size at its limit; no model is "
       "written",
       "Correct the log, or drive what is missing; the reason says which."}};
  return all;
}

const std::vector<Word>& firstSteps() {
  static const std::vector<Word> steps{
      {"drive",
       "at least 200 s, better 10 minutes: three speeds forwards and backwards, turns on the spot, "
       "arcs both ways, sudden changes, 30 s of standing still"},
      {"write a CSV",
       "20 rows a second with the columns step (a number, the same as long as the log does not "
       "pause), t_s, cmd_left_rad_s, cmd_right_rad_s, wheel_left_rad_s, wheel_right_rad_s (of "
       "wheels or sprockets), x_m, y_m, yaw_rad, z_m, roll_rad, pitch_rad (the newest pose), "
       "pose_new (1 in rows with a new pose, else 0), imu_yaw_rate_rad_s (left is positive)"},
      {"describe it",
       "sessions.csv with one row: session (the CSV's name without .csv), robot, surface, "
       "wheel_radius_m, baseline_m (between the tracks), pose_lag_s (0), pose_rate_hz, "
       "imu_sign_applied (1), roll_pitch (absolute), n_rows (of the CSV)"},
      {"import",
       "tread-import --format steps --keep-lag --gyro all --sessions sessions.csv mine.csv -o "
       "mine.lcmlog"},
      {"or log LCM", "a log with the robot's INS and MOTOR messages needs no import"},
      {"first model",
       "ideal.yaml, three lines: 'name: ideal', 'kind: track_speed', 'gauge: 1.08' (baseline_m); "
       "for an LCM log whose commands are powers from -1 to 1 'kind: power' and the speed at full "
       "power, 'full_speed: 2.0' (m/s)"},
      {"find",
       "tread-gap find --model ideal.yaml --train mine.lcmlog --out gap; with --calibrate lag, "
       "delay and gains become numbers of the new model instead of effects by name"},
      {"read", "gap/report.html; then tread-gap explain verdicts"}};
  return steps;
}

constexpr size_t kWidth = 96;
constexpr size_t kIndent = 18;
constexpr size_t kTopicIndent = 20;

/// Breaks text into lines of at most `width` characters; all but the first are indented.
std::string wrapped(const std::string& text, size_t width, size_t indent) {
  std::string lines;
  std::string line;
  size_t at = 0;
  while (at < text.size()) {
    // Spaces belong to the following word, so that an indented heading keeps its own.
    size_t end = text.find_first_not_of(' ', at);
    end = text.find(' ', end == std::string::npos ? text.size() : end);
    const std::string word =
        text.substr(at, end == std::string::npos ? std::string::npos : end - at);
    if (line.size() + word.size() > width && line.size() > indent) {
      lines += line + "\n";
      line = std::string(indent, ' ') + word.substr(word.find_first_not_of(' '));
    } else {
      line += word;
    }
    at = end == std::string::npos ? text.size() : end;
  }
  return lines + line;
}

std::string padded(const std::string& text, size_t width) {
  return text.size() < width ? text + std::string(width - text.size(), ' ') : text + " ";
}

std::string entry(const std::string& heading, const std::string& text, size_t indent = kIndent) {
  return wrapped(padded(heading, indent) + text, kWidth, indent) + "\n";
}

/// The channels that an effect changes, in words.
std::string channelWords(const std::string& channels) {
  std::vector<std::string> words;
  for (const char channel : channels)
    words.push_back(channel == 'x'   ? "speed along the track"
                    : channel == 'y' ? "motion to the side"
                                     : "yaw rate");
  return joined(words);
}

std::string parameterWords(const EffectParameter& parameter) {
  if (parameter.reciprocal())
    return parameter.natural_name + " above " + said(1.0 / parameter.max, naturalUnit(parameter)) +
           ", for instance " + said(1.0 / parameter.typical, naturalUnit(parameter)) +
           " (in model files " + parameter.natural_name + ", or " + parameter.name +
           ", its reciprocal)";
  const bool shape = parameter.role == ParameterRole::kShape;
  return parameter.name + " " + saidInterval(parameter.min, parameter.max, parameter.unit) +
         ", for instance " + said(parameter.typical, parameter.unit) + " (in model files " +
         formatNumber(parameter.typical) + (parameter.unit == "1" ? "" : " " + parameter.unit) +
         ")" + (shape ? "; says when or how, not how much" : "");
}

std::string groupWords(const Effect& effect, const ConfoundedGroup& group) {
  std::vector<std::string> others;
  for (const std::string& member : group.members)
    if (member != effect.name) others.push_back(member);
  std::string text = joined(others, "or");
  if (!group.when.empty()) text += ", " + group.when;
  return text + ": " + group.because + ". " + group.separates;
}

std::string entries(const std::vector<Word>& words) {
  std::string text;
  for (const Word& word : words) text += entry(word.word, word.meaning, kTopicIndent);
  return text;
}

std::string verdicts() {
  std::string text;
  for (const Advice& advice : advices())
    text += entry(std::to_string(exitStatus(advice.verdict)) + " " + verdictName(advice.verdict),
                  advice.meaning + ". " + advice.next, kTopicIndent);
  return text + entry("2", "bad input, in one line", kTopicIndent);
}

}  // namespace

const std::vector<Word>& glossary() {
  static const std::vector<Word> words{
      {"execution", "2 s of driving that the model predicts from its measured beginning"},
      {"end error",
       "how far the predicted pose is from the measured one at the end of an execution"},
      {"held-out", "driving that was not used for the fit; only its errors count as evidence"},
      {"block",
       "about 20 s of driving, long enough to be independent of the next one (shorter in a drive "
       "below 200 s, which needs more evidence); significance is counted in blocks, not in "
       "samples"},
      {"nats",
       "unit of evidence: the model makes held-out data e^n times as likely; a gain counts when it "
       "is well above its standard error"},
      {"score, p",
       "how clearly the residuals show an effect's signature, and the probability of such a score "
       "anywhere in the catalogue without any effect"},
      {"group",
       "confounded effects: they look the same to the INS; a tape measure or another sensor "
       "distinguishes them"},
      {"runner-up",
       "another effect that explains the drive; one within its standard error is equally good"},
      {"adequacy",
       "the test whether the residuals still depend on anything (speed, yaw rate, "
       "time..)"},
      {"floor",
       "the end error of dead reckoning with encoders and gyro: the best that a model can reach"},
      {"negligible", "significant, but below 1 % of the end error: not added"},
      {"envelope",
       "the fastest motions from which the model was made; beyond them it extrapolates"}};
  return words;
}

const Advice& adviceFor(GapVerdict verdict) {
  return *std::find_if(advices().begin(), advices().end(),
                       [verdict](const Advice& advice) { return advice.verdict == verdict; });
}

namespace {

/// Vehicles that can have an effect; empty if all can.
std::string vehiclesWith(const Effect& effect) {
  std::vector<std::string> names;
  const auto all = {VehicleLayout::kTracks, VehicleLayout::kCar, VehicleLayout::kOmni};
  for (const VehicleLayout layout : all)
    if (effect.isOf(layout)) names.emplace_back(nameOf(layout));
  if (names.size() == all.size()) return "";
  return names.size() == 1 ? names.front() : names.front() + " and " + names.back();
}

}  // namespace

std::string explanation(const Effect& effect) {
  std::string text =
      effect.title + " - " + effect.name + ", " +
      (effect.kind() == EffectKind::kVehicle ? "of the vehicle" : "of the measurement") + "\n\n";
  text += entry("what it is", effect.sentence);
  text += entry("equation", effect.equation);
  std::string heading = "parameters";
  for (const EffectParameter& parameter : effect.parameters) {
    text += entry(heading, parameterWords(parameter));
    heading.clear();
  }
  if (const std::string vehicles = vehiclesWith(effect); !vehicles.empty())
    text += entry("vehicles", vehicles);
  text += entry("changes", channelWords(effect.channels));
  text += entry("looks like", effect.looks_like);
  text += entry("tell it apart", effect.separates);
  heading = "confused with";
  for (const ConfoundedGroup* group : confoundedGroupsOf(effect.name)) {
    text += entry(heading, groupWords(effect, *group));
    heading.clear();
  }
  text += entry("in two minutes", effect.check);
  return text;
}

std::string listOfEffects() {
  std::string text;
  for (const EffectKind kind : {EffectKind::kVehicle, EffectKind::kMeasurement}) {
    text += kind == EffectKind::kVehicle ? "Effects of the vehicle:\n"
                                         : "\nEffects of the measurement:\n";
    for (const Effect& effect : effectCatalogue())
      if (effect.kind() == kind) text += "  " + padded(effect.name, 22) + effect.sentence + "\n";
  }
  return text;
}

std::optional<std::string> topic(const std::string& name) {
  if (name == "start") return entries(firstSteps());
  if (name == "verdicts") return verdicts();
  if (name == "words") return entries(glossary());
  return std::nullopt;
}

std::string listOfTopics() {
  return "\nBeside effects:\n"
         "  start                 from your log to a first run\n"
         "  verdicts              the meaning of each verdict and the next step\n"
         "  words                 what block, nats, adequacy, held-out .. mean\n";
}

}  // namespace tread::gap
