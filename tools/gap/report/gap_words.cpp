// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/report/gap_words.hpp"

#include <map>

#include "tools/gap/report/effect_words.hpp"

namespace tread::gap {
namespace {

constexpr double kNegligible = 0.01;  // of an error: less is no change

std::string saidErrors(const EndErrors& errors, bool rms) {
  return saidDistance(rms ? errors.position.rms : errors.position.median) + " and " +
         saidAngle(rms ? errors.yaw.rms : errors.yaw.median);
}

/// Dead reckoning bounds what a model can do only as long as no model does better.
std::string floorWords(const Gap& gap) {
  std::vector<std::string> better;
  if (gap.after.position.median < gap.floor->position.median) better.emplace_back("position");
  if (gap.after.yaw.median < gap.floor->yaw.median) better.emplace_back("heading");
  const std::string reaches = " reaches " + saidErrors(*gap.floor, false);
  if (better.empty())
    return " Dead reckoning with encoders and gyro, about the best that is possible," + reaches +
           ".";
  return " Dead reckoning with encoders and gyro" + reaches + "; the new model does better in " +
         joined(better) + ".";
}

/// A median before and after.
struct Change {
  const char* what;
  double before;
  double after;
  std::string (*said)(double);

  bool isWorse() const { return after > (1.0 + kNegligible) * before; }
  bool isBetter() const { return after < before; }
};

}  // namespace

std::string gainOf(const Gap& gap) {
  std::string text =
      threeDigits(gap.horizon) +
      " s end-pose error on driving it has not seen: " + threeDigits(gap.before.position.median) +
      " -> " + saidDistance(gap.after.position.median) + ", heading " +
      threeDigits(gap.before.yaw.median * 180.0 / kPi) + " -> " + saidAngle(gap.after.yaw.median) +
      " (median of " + std::to_string(gap.after.executions) + " executions; rms " +
      saidErrors(gap.before, true) + " -> " + saidErrors(gap.after, true) + ").";
  if (gap.floor) text += floorWords(gap);
  if (!gap.structure_nested)
    text +=
        " The parameters were fitted without these executions, the effects were chosen with "
        "them.";
  return text;
}

std::string worseOf(const Gap& gap) {
  const Change changes[] = {
      {"position", gap.before.position.median, gap.after.position.median, saidDistance},
      {"heading", gap.before.yaw.median, gap.after.yaw.median, saidAngle}};
  std::vector<std::string> worse;
  std::string better;
  for (const Change& change : changes) {
    if (change.isWorse())
      worse.push_back(std::string(change.what) + " (median " + change.said(change.before) +
                      " before, " + change.said(change.after) + " now)");
    if (change.isBetter()) better = change.what;
  }
  if (worse.empty()) return "";
  return "Not better, but worse on driving it has not seen: " + joined(worse) +
         (better.empty() ? "." : "; only " + better + " got better.");
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

}  // namespace tread::gap
