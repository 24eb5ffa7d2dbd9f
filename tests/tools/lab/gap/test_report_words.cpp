// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "tests/tools/lab/gap/sample_findings.hpp"
#include "tools/lab/gap/report/find_output.hpp"
#include "tools/lab/gap/report/headline.hpp"
#include "tools/lab/gap/report/pictures.hpp"
#include "tools/lab/gap/report/sections.hpp"
#include "tools/lab/gap/report/words.hpp"

namespace tread::gap {
namespace {

using samples::has;

FoundEffect effect(const std::string& name, const std::vector<std::string>& as_good = {},
                   double gain = 10.0) {
  FoundEffect found;
  found.name = name;
  found.gain = gain;
  for (const std::string& other : as_good) found.runner_ups.push_back({other, 1.0, 2.0});
  return found;
}

GapFinding withEffects(GapVerdict verdict, const std::vector<FoundEffect>& effects) {
  GapFinding finding = samples::finding(verdict);
  finding.identified.effects = effects;
  return finding;
}

std::string headline(GapVerdict verdict, const std::vector<FoundEffect>& effects) {
  return headlineOf(withEffects(verdict, effects));
}

std::string report(const GapFinding& finding) {
  return markdownOf(reportPage(finding, samples::inputs()));
}

size_t count(const std::string& text, const std::string& words) {
  size_t times = 0;
  for (size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1))
    ++times;
  return times;
}

FoundEffect sized(const std::string& path, const std::string& unit, double value) {
  FoundEffect found = effect(path.substr(0, path.find('.')));
  found.parameters = {{path, unit, value, value - 0.01, value + 0.01, 0.0}};
  return found;
}

/// A finding whose new model has this parameter.
GapFinding withSize(const FoundEffect& found) {
  GapFinding finding = withEffects(GapVerdict::kFound, {found});
  const ParameterEstimate& estimate = found.parameters.front();
  *findParameter(finding.identified.model, estimate.parameter) = estimate.value;
  return finding;
}

}  // namespace

TEST_CASE("a headline that leaves names open is one line, with what is sure before it") {
  CHECK(headline(GapVerdict::kAmbiguous, {effect("yaw_pull", {"track_asymmetry"})}) ==
        "Yaw pull or left-right asymmetry: this drive cannot tell them apart");
  CHECK(headline(GapVerdict::kAmbiguous,
                 {effect("slip_ratio"), effect("yaw_pull", {"track_asymmetry"})}) ==
        "Found: Longitudinal slip; and Yaw pull or left-right asymmetry: this drive cannot tell "
        "them apart");
  CHECK(
      headline(GapVerdict::kAmbiguous, {effect("yaw_pull", {"crab", "gyro_bias", "grip_limit"})}) ==
      "Yaw pull or one of 3 others: this drive cannot tell them apart");
  CHECK(headline(GapVerdict::kAmbiguous, {effect("slip_ratio"), effect("crab", {"yaw_pull"}),
                                          effect("yaw_pull", {"track_asymmetry"})}) ==
        "Found: Longitudinal slip; not sure by name: Crabbing and Yaw pull");
  CHECK(
      headline(GapVerdict::kFound, {effect("slip_ratio", {}, 1.0), effect("crab", {}, 9.0),
                                    effect("grip_limit", {}, 5.0), effect("yaw_pull", {}, 2.0)}) ==
      "Found: Crabbing, Grip limit and 2 more");
}

TEST_CASE("a brief drive lists by name what it cannot tell, and claims no more than it tested") {
  GapFinding finding = withEffects(GapVerdict::kNoDiscrepancy, {});
  finding.source.brief = true;
  finding.source.blocks = 10;
  finding.source.block_length = 6.0;
  finding.identified.calibrated.clear();
  CHECK(headlineOf(finding) == "Simulation and measurement agree as far as this brief drive shows");
  const std::vector<std::string> lines = closingLines(finding);
  REQUIRE(lines.size() > 1);
  CHECK(lines[1] ==
        "  60 s of driving: only effects that it would show in their usual size are judged. "
        "CANNOT_TELL: grip_limit and slope_pitch. The report says what would show them. "
        "Differences without a name are tested from 200 s on.");
  CHECK(report(finding).find("significantly, over") == std::string::npos);
  finding.verdict = GapVerdict::kNothingNew;
  CHECK(headlineOf(finding) == "Nothing new that this brief drive would show");
}

TEST_CASE("a name that is open is marked under PARTIAL, too, and what it could be is listed") {
  const GapFinding finding =
      withEffects(GapVerdict::kPartial, {effect("slip_ratio"), samples::icrOffset()});
  CHECK(headlineOf(finding) ==
        "Found: Longitudinal slip; and Centre of rotation ahead of or behind the middle or lever "
        "arm along the vehicle: this drive cannot tell them apart; and something unnamed");
  CHECK(has(report(finding),
            "- Centre of rotation ahead of or behind the middle could also be lever arm along the "
            "vehicle. To tell: Measure the lever arm with a tape."));
}

TEST_CASE("the latency that a delay may be is not the one that the model may have beside it") {
  FoundEffect delay = effect("command_delay");
  delay.group = {"ins_latency"};
  CHECK(headline(GapVerdict::kAmbiguous, {delay, effect("ins_latency")}) ==
        "Found: INS latency; and Command delay or INS latency of poses and gyro alike: this drive "
        "cannot tell them apart");
}

TEST_CASE("two effects that may be taken for each other are one pair, whichever was found first") {
  const GapFinding finding = withEffects(
      GapVerdict::kPartial,
      {effect("yaw_pull", {"track_asymmetry"}), effect("track_asymmetry", {"yaw_pull", "crab"})});
  const std::vector<RivalPair> pairs = rivalPairs(finding);
  REQUIRE(pairs.size() == 2);
  CHECK(pairs[0].found == "yaw_pull");
  CHECK(pairs[1].other == "crab");
  CHECK(count(report(finding), "tread-gap plan ") == 2);
}

TEST_CASE("no drive is planned for twins that want another measurement") {
  const std::string text = report(samples::finding(GapVerdict::kAmbiguous));
  CHECK(has(text,
            "this drive cannot tell them apart. v_y = -offset omega in both. To tell: "
            "Measure the lever arm with a tape."));
  CHECK_FALSE(has(text, "tread-gap plan"));
}

TEST_CASE("dead reckoning is the best possible only where the model does not beat it") {
  Gap gap = *samples::finding(GapVerdict::kFound).gap;
  CHECK(has(gainOf(gap), "about the best that is possible"));
  gap.after.position.median = 0.2;
  CHECK_FALSE(has(gainOf(gap), "best"));
  CHECK_FALSE(has(gapPicture(gap, false), "floor"));
  CHECK(has(gapPicture(gap, true), "floor"));
  CHECK(has(gainOf(gap), "reaches 0.290 m and 5.73 deg; the new model does better in position."));
}

TEST_CASE("where fitting the model's numbers is what makes it agree, the headline says so") {
  GapFinding finding = samples::finding(GapVerdict::kNoDiscrepancy);
  CHECK(has(headlineOf(finding), "agree, once the model's own numbers are fitted"));
  CHECK(has(report(finding), "That done: Prediction and INS"));
  finding.gap->after = finding.gap->before;
  CHECK(headlineOf(finding) == "Simulation and measurement agree");
}

TEST_CASE("what got worse on unseen driving is named") {
  Gap gap = *samples::finding(GapVerdict::kFound).gap;
  CHECK(worseOf(gap) == "");
  gap.after.position.median = 0.7;
  CHECK(worseOf(gap) ==
        "Not better, but worse on held-out driving: position (median 0.642 m before, 0.700 "
        "m now); only heading got better.");
  gap.after.yaw.median = 0.5;
  CHECK(has(worseOf(gap), "0.700 m now) and heading (median 20.5 deg before, 28.6 deg now)."));
  GapFinding finding = samples::finding(GapVerdict::kFound);
  finding.gap = gap;
  // A change of a median within its uncertainty is no deterioration.
  gap.by_chance = {0.04, 0.01};
  CHECK(has(worseOf(gap), "held-out driving: heading (median"));
  gap.by_chance.yaw = 0.08;
  CHECK(worseOf(gap) == "");
  const std::vector<std::string> lines = closingLines(finding);
  CHECK(std::count(lines.begin(), lines.end(), "  " + worseOf(*finding.gap)) == 1);
  CHECK(has(report(finding), worseOf(*finding.gap)));
}

TEST_CASE("what find prints at its end begins with the verdict and tells what remains") {
  const std::vector<std::string> lines = closingLines(samples::finding(GapVerdict::kPartial));
  CHECK(lines.front().find("PARTIAL: Found: ") == 0);
  CHECK(closingLines(samples::finding(GapVerdict::kFound)).front() ==
        "FOUND: Limit of turning power and Left-right asymmetry");
  CHECK(has(closingLines(samples::finding(GapVerdict::kAmbiguous)).back(),
            "To tell: Measure the lever arm with a tape."));
  CHECK(std::count(lines.begin(), lines.end(),
                   "  Unexplained: the yaw rate residual depends on speed x yaw rate (like skid "
                   "that grows with "
                   "the yaw rate, but not taken for it).") == 1);
}

TEST_CASE("a term on top of what the model had shows their total beside") {
  const GapFinding finding = withSize(sized("actuator_lag.lag", "s", 0.2));
  CHECK(has(sentenceOf(finding.identified.effects[0], finding.identified.model),
            "; lag in all 0.370 s."));
  CHECK(has(report(finding),
            "| lag | off | 0.200 s | 0.190 to 0.210 s | -0.170 to 5 s | lag in "
            "all 0.370 s |"));
  CHECK_FALSE(has(report(samples::finding(GapVerdict::kMeasurement)), "| in all |"));
}

TEST_CASE("a parameter at the end of what is plausible is marked, with what to do") {
  GapFinding finding = withSize(sized("lag_asymmetry.slowing", "s", -2.0));
  CHECK(has(report(finding), "| -2 s (at its limit) |"));
  finding.verdict = GapVerdict::kCannotTell;
  CHECK(has(report(finding), "or leave it out: --reject lag_asymmetry."));
  CHECK(has(report(finding), "No model was written."));
  CHECK_FALSE(has(report(finding), "new model holds"));
  CHECK(has(report(finding), "## Parameters where the fit ended"));
  CHECK_FALSE(hasNewModel(finding));
}

TEST_CASE(
    "each effect is told by its name and in a sentence, in the report and at the end of find") {
  const GapFinding finding = samples::finding(GapVerdict::kFound);
  const std::string sentence =
      "Limit of turning power: the drive hardly turns the vehicle faster than a certain yaw rate "
      "on "
      "this ground: limit 1.25 rad/s (1.22 to 1.28 rad/s).";
  CHECK(has(report(finding), "- " + sentence + "\n"));
  CHECK(closingLines(finding)[1] == "  " + sentence);
}

TEST_CASE("a negative slip sends people to the wheel radius") {
  const FoundEffect slip = sized("slip_ratio.slip", "1", -0.07);
  CHECK(has(sentenceOf(slip), "check the wheel radius"));
  CHECK(has(checkOf(slip), "it may be too small by 7.00 %") == false);
  CHECK(has(checkOf(slip), "it may be too small by 7 %"));
  CHECK_FALSE(has(checkOf(sized("slip_ratio.slip", "1", 0.07)), "radius"));
}

TEST_CASE("a limit is visible from the gentlest one on, and what was found is said to be") {
  const std::string text = report(samples::finding(GapVerdict::kNoDiscrepancy));
  CHECK(has(text, "| limit of 2.50 rad/s or below |"));
  CHECK(has(text, "| no limit that was tried |"));
  CHECK(has(report(samples::finding(GapVerdict::kFound)), "| 80 % | found |"));
}

TEST_CASE("a report says what to do after its verdict, and what its words mean") {
  const GapFinding finding = samples::finding(GapVerdict::kMeasurement);
  CHECK(has(report(finding), "What to do: Correct the INS: lever arm, mounting, time stamps."));
  CHECK(has(report(finding), "| nats | unit of evidence"));
}

TEST_CASE("a number of the model that has changed is named, with the effect like it") {
  GapFinding finding;
  finding.identified.calibrated = {{"forward_gain", "1", 1.08, 1.07, 1.09, 1.11, true}};
  CHECK(sentencesOf(finding).back() ==
        "A number of the model has changed: forward_gain 108 % (107 to 109 %) instead of "
        "111 %; longitudinal slip would have the same effect.");
}

TEST_CASE("a term of the model that has changed is said in its natural numbers") {
  GapFinding finding = samples::finding(GapVerdict::kNoDiscrepancy);
  finding.identified.calibrated = {
      {"turn_power_limit.inverse_limit", "s/rad", 0.8, 0.78, 0.82, 0.5, true}};
  CHECK(sentencesOf(finding).back() ==
        "Limit of turning power, which the model has, has changed: limit 1.25 rad/s (1.22 "
        "to 1.28 rad/s) instead of 2 rad/s.");
}

TEST_CASE("only a vehicle of which it is known what is new is to be looked at") {
  GapFinding finding = samples::finding(GapVerdict::kNotInCatalogue);
  CHECK_FALSE(has(report(finding), "Look at the vehicle"));
  CHECK(has(report(finding), "The vehicle may be unchanged"));
  finding.before.rest.emplace();
  CHECK(has(report(finding), "Look at the vehicle"));
  CHECK_FALSE(has(report(samples::finding(GapVerdict::kNothingNew)), "Look at the vehicle"));
}

TEST_CASE("a search that was cut short says so in one line, and not that something is left over") {
  GapFinding finding = samples::finding(GapVerdict::kPartial);
  const std::string rest = "something unnamed";
  const std::string limit = "The search had no time left (--limit)";
  CHECK(has(closingLines(finding).front(), rest));
  CHECK_FALSE(has(report(finding), limit));
  finding.search.cut_short = true;
  CHECK_FALSE(has(closingLines(finding).front(), rest));
  CHECK(has(closingLines(finding)[1], limit));
  CHECK(has(report(finding), limit));
}

}  // namespace tread::gap
