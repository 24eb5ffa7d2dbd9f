// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cctype>
#include <set>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "common/vehicle/model_file.hpp"
#include "tests/tools/lab/gap/sample_findings.hpp"
#include "tools/lab/gap/report/evidence_words.hpp"
#include "tools/lab/gap/report/find_output.hpp"
#include "tools/lab/gap/report/headline.hpp"
#include "tools/lab/gap/report/pictures.hpp"
#include "tools/lab/gap/report/sections.hpp"
#include "tools/lab/gap/report/words.hpp"

namespace tread::gap {
namespace {

using samples::has;

const GapVerdict kVerdicts[] = {GapVerdict::kNoDiscrepancy, GapVerdict::kNothingNew,
                                GapVerdict::kFound,         GapVerdict::kAmbiguous,
                                GapVerdict::kPartial,       GapVerdict::kNotInCatalogue,
                                GapVerdict::kMeasurement,   GapVerdict::kCannotTell};

std::string html(GapVerdict verdict) {
  return htmlOf(reportPage(samples::finding(verdict), samples::inputs()));
}

std::string markdown(GapVerdict verdict) {
  return markdownOf(reportPage(samples::finding(verdict), samples::inputs()));
}

/// The first tag that is not closed in order; empty = well-formed.
std::string unbalanced(const std::string& text) {
  const std::set<std::string> kEmpty = {"meta", "!DOCTYPE"};
  std::vector<std::string> open;
  for (size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at + 1)) {
    const size_t end = text.find('>', at);
    if (end == std::string::npos || text.find('<', at + 1) < end) return text.substr(at, 40);
    std::string tag = text.substr(at + 1, end - at - 1);
    const bool closes = tag[0] == '/';
    const bool empty = tag.back() == '/';
    tag = tag.substr(closes ? 1 : 0, tag.find_first_of(" /\n", closes ? 1 : 0) - (closes ? 1 : 0));
    if (empty || kEmpty.count(tag) > 0) continue;
    if (!closes) {
      open.push_back(tag);
    } else if (open.empty() || open.back() != tag) {
      return text.substr(at, 40);
    } else {
      open.pop_back();
    }
  }
  return open.empty() ? "" : open.back();
}

}  // namespace

TEST_CASE("a report is well-formed HTML without scripts or anything from elsewhere") {
  for (const GapVerdict verdict : kVerdicts) {
    const std::string text = html(verdict);
    INFO(verdictName(verdict));
    CHECK(unbalanced(text) == "");
    CHECK_FALSE(has(text, "<script"));
    CHECK_FALSE(has(text, "src="));
    CHECK_FALSE(has(text, "href="));
    CHECK_FALSE(has(text, "nan"));
    CHECK(has(text, "width=device-width"));
    CHECK(has(text, "b&lt;c&gt;.lcmlog"));
  }
}

TEST_CASE("the same finding gives the same bytes") {
  for (const GapVerdict verdict : kVerdicts) {
    CHECK(html(verdict) == html(verdict));
    CHECK(markdown(verdict) == markdown(verdict));
  }
}

TEST_CASE("the headline says the verdict in words, and the first screen the gain") {
  CHECK(headlineOf(samples::finding(GapVerdict::kFound)) ==
        "Found: Limit of turning power and Left-right asymmetry");
  CHECK(headlineOf(samples::finding(GapVerdict::kAmbiguous)) ==
        "Centre of rotation ahead of or behind the middle or lever arm along the vehicle: this "
        "drive cannot tell them apart");
  CHECK(headlineOf(samples::finding(GapVerdict::kMeasurement)) ==
        "The INS, not the vehicle: INS mounted askew");
  const std::string text = markdown(GapVerdict::kFound);
  CHECK(has(text,
            "2 s end-pose error on held-out driving: 0.642 -> 0.451 m, heading 20.5 -> 10.7 "
            "deg (median of 60 executions"));
  CHECK(text.find("2 s end-pose error") < text.find("## What was found"));
  CHECK(has(text, "reaches 0.290 m and 5.73 deg"));
}

TEST_CASE("a found effect is said with its natural number, interval and direction") {
  CHECK(sentenceOf(samples::turnLimit()) ==
        "The drive hardly turns the vehicle faster than a certain yaw rate on this ground: limit "
        "1.25 rad/s (1.22 to 1.28 rad/s).");
  CHECK(sentenceOf(samples::asymmetry()) ==
        "One track runs a little faster than the other at the same command: share -2.98 % (-3.40 "
        "to -2.60 %); the right track is the faster one.");
}

TEST_CASE("where a sign turns an effect round, its sentence says so") {
  FoundEffect effect;
  effect.name = "heading_latency";
  effect.parameters = {{"heading_latency.latency", "s", -0.17, -0.18, -0.16, 0.0}};
  CHECK(sentenceOf(effect) ==
        "The position of a pose is older than its heading: latency -0.170 s (-0.180 to -0.160 s).");
}

TEST_CASE("what remains is told channel by channel") {
  CHECK(remainsOf({{"along", "speed", 3.0, 0.01},
                   {"yaw rate", "v", 3.0, 0.01},
                   {"along", "time", 3.0, 0.01}}) ==
        "the along residual depends on speed and time; the yaw rate residual depends on v");
  CHECK(remainsOf({{"along", "speed", 3.0, 0.01, "slip_ratio"}}) ==
        "the along residual depends on speed (like longitudinal slip, but not taken for it)");
}

TEST_CASE("what is left without a name is drawn beside the headline") {
  GapFinding finding = samples::finding(GapVerdict::kPartial);
  CHECK(restPictures(finding).svg.empty());
  for (size_t i = 0; i < 5; ++i) {
    finding.atlas.curves.push_back(finding.atlas.curves.front());
    finding.atlas.curves.back().unexplained = true;
  }
  CHECK(restPictures(finding).svg.size() == 3);
  std::ostringstream html;
  CHECK(markdownOf(reportPage(finding, {}))
            .find("Residuals over the variables that they depend on") != std::string::npos);
}

TEST_CASE("after an effect stands where the wheel speeds say that it is") {
  GapFinding finding = samples::finding(GapVerdict::kFound);
  const auto sentenceWith = [&](double value, double low, double high) {
    finding.identified.effects[0].evidence = {{EvidenceSource::kWheels, value, low, high}};
    return sentencesOf(finding).front();
  };
  CHECK_THAT(
      sentenceWith(0.97, 0.9, 1.04),
      Catch::EndsWith("The wheel speeds show 97 % of it (90 to 104 %): it is in the drive."));
  CHECK_THAT(sentenceWith(1.5, 1.4, 1.6),
             Catch::Contains("show all of it and more (140 to 160 %): it is in the drive."));
  CHECK_THAT(sentenceWith(0.1, -0.1, 0.3),
             Catch::EndsWith("it is under the wheels, not in the drive."));
  CHECK_THAT(sentenceWith(0.5, 0.3, 0.7), Catch::EndsWith("whether it is in the drive."));
}

TEST_CASE("after it stands whether it is load, as the motor currents say") {
  FoundEffect effect = samples::turnLimit();
  CHECK(evidenceSentences(effect).empty());
  effect.evidence = {{EvidenceSource::kCurrents, 12.0, 10.0, 14.0}};
  CHECK_THAT(evidenceSentences(effect),
             Catch::Contains("rise by 12.0 % per percent (10.0 to 14.0): it is load"));
  effect.evidence = {{EvidenceSource::kCurrents, 0.9, 0.2, 1.6}};
  CHECK_THAT(evidenceSentences(effect), Catch::Contains("do not show whether it is load"));
  effect.evidence = {{EvidenceSource::kCurrents, 0.1, -0.1, 0.3}};
  CHECK_THAT(evidenceSentences(effect),
             Catch::EndsWith("by 0.1 % per percent (-0.1 to 0.3): the drive gives less, or the "
                             "tracks slip."));
}

TEST_CASE("wheel speeds and motor currents together tell the drive, the load and slipping tracks") {
  FoundEffect effect = samples::turnLimit();
  const MeasuredEvidence in_wheels{EvidenceSource::kWheels, 0.97, 0.9, 1.04};
  const MeasuredEvidence under_wheels{EvidenceSource::kWheels, 0.1, -0.1, 0.3};
  const MeasuredEvidence no_load{EvidenceSource::kCurrents, 0.1, -0.1, 0.3};
  effect.evidence = {in_wheels, no_load};
  CHECK_THAT(evidenceSentences(effect), Catch::EndsWith("(-0.1 to 0.3): the drive gives less."));
  effect.evidence = {under_wheels, no_load};
  CHECK_THAT(evidenceSentences(effect), Catch::EndsWith("(-0.1 to 0.3): the tracks slip."));
  effect.evidence = {in_wheels, {EvidenceSource::kCurrents, 12.0, 10.0, 14.0}};
  CHECK_THAT(evidenceSentences(effect), !Catch::Contains("in the drive"));
  CHECK_THAT(evidenceSentences(effect), Catch::Contains("the wheels turn slower"));
}

TEST_CASE("after it stands whether it is the battery, as the voltage says") {
  FoundEffect effect = samples::turnLimit();
  effect.evidence = {{EvidenceSource::kVoltage, 0.98, 0.9, 1.06}};
  CHECK_THAT(evidenceSentences(effect),
             Catch::EndsWith("falls with it, 98 % as much (90 to 106 %): it may be the battery."));
  effect.name = "battery_sag";
  CHECK_THAT(evidenceSentences(effect), Catch::EndsWith(": it is the battery."));
  effect.evidence = {{EvidenceSource::kVoltage, 0.02, 0.0, 0.04}};
  CHECK_THAT(evidenceSentences(effect), Catch::EndsWith("(0 to 4 %): it is not the battery."));
  effect.evidence = {{EvidenceSource::kVoltage, 0.5, 0.2, 0.8}};
  CHECK_THAT(evidenceSentences(effect), Catch::EndsWith("show whether it is the battery."));
}

TEST_CASE("a report shows where, how, step by step, the parameters and what else it could be") {
  const std::string text = markdown(GapVerdict::kFound);
  for (const char* words : {"Where simulation and measurement disagree",
                            "Executions, as measured and as predicted",
                            "contain 9 of 10 of all 60 such executions",
                            "Where on the ground",
                            "Step by step",
                            "Parameters of the new model",
                            "Alternatives, and",
                            "What this drive could not show",
                            "Where the new model holds",
                            "State of the logs",
                            "All candidates",
                            "Versions and files",
                            "lag and delay: correlation 0.950",
                            "tread-gap plan track_asymmetry yaw_pull",
                            "52 % of the poses",
                            "no limit that was tried",
                            "30 independent blocks",
                            "up to 1.10 m/s, 2.40 rad/s",
                            "Real but too small to matter",
                            "| Limit of turning power | limit | off | 1.25 rad/s |"}) {
    INFO(words);
    CHECK(has(text, words));
  }
  const std::string page = html(GapVerdict::kFound);
  CHECK(has(page, "yaw rate over yaw rate"));
  CHECK(has(page, "worst, 100 s of a<"));
  CHECK(has(page, "full colour = 0.600 rad/s"));
  CHECK(has(page, "<g opacity=\"0.16\">"));
  CHECK(has(page, "full colour: 0.170 m and more"));
  GapFinding blind = samples::finding(GapVerdict::kFound);
  blind.shown.places.clear();
  CHECK(has(markdownOf(reportPage(blind, samples::inputs())), "the logs have no absolute poses"));
}

TEST_CASE("effects that cannot be told apart come with the measurement that tells") {
  const std::string text = markdown(GapVerdict::kAmbiguous);
  CHECK(has(text, "To tell: Measure the lever arm with a tape."));
}

TEST_CASE("what remains without a name is told by channel and variable") {
  CHECK(has(
      markdown(GapVerdict::kPartial),
      "Unexplained: the yaw rate residual depends on speed x yaw rate (like skid that grows with "
      "the yaw rate, but not taken for it)."));
  CHECK(has(markdown(GapVerdict::kNotInCatalogue), "no effect of the catalogue explains"));
}

TEST_CASE("a drive that cannot tell says why and shows no numbers that were not measured") {
  const std::string text = markdown(GapVerdict::kCannotTell);
  CHECK(has(text, "6 independent blocks of 20 s; 10 are needed"));
  CHECK_FALSE(has(text, "end-pose error"));
}

TEST_CASE("the report of a brief drive claims no test of the residuals") {
  GapFinding finding = samples::finding(GapVerdict::kFound);
  finding.source.blocks = 10;
  CHECK(has(markdownOf(reportPage(finding, samples::inputs())), "Test of the residuals: p"));
  finding.source.brief = true;
  const std::string brief = markdownOf(reportPage(finding, samples::inputs()));
  CHECK_FALSE(has(brief, "Test of the residuals"));
  CHECK_FALSE(has(brief, "independent blocks"));
  CHECK(has(brief, "the residuals were not tested"));
}

TEST_CASE("the new model is read back with its provenance and envelope") {
  const GapFinding finding = samples::finding(GapVerdict::kFound);
  const ModelDocument model = newModel(finding, samples::inputs());
  const ModelDocument read = parseModelDocument(formatModelDocument(model), "model.yaml");
  CHECK(read.vehicle.effects.turn_power_limit == 0.8);
  CHECK(read.provenance.tool == toolVersion());
  CHECK(read.provenance.seed == 7);
  CHECK(read.provenance.runs == 1);
  REQUIRE(read.provenance.logs.size() == 1);
  CHECK(read.provenance.logs[0].name == "a.lcmlog");
  CHECK(read.envelope->omega == 2.4);
}

TEST_CASE("a covariance that rounding made unequal in its halves can be read back") {
  GapFinding finding = samples::finding(GapVerdict::kFound);
  finding.identified.model.covariance.matrix[0][1] += 1e-19;
  REQUIRE(finding.identified.model.covariance.matrix[0][1] !=
          finding.identified.model.covariance.matrix[1][0]);
  CHECK_NOTHROW(parseModelDocument(formatModelDocument(newModel(finding, samples::inputs())), "m"));
}

TEST_CASE("a term without a name is said, drawn with its band, in all files, and can be named") {
  GapFinding finding = samples::finding(GapVerdict::kNotInCatalogue);
  UnnamedTerm term;
  term.name = "unnamed_1";
  term.condition = findTermCondition("change of |yaw rate|");
  term.times = findTermCondition("yaw rate");
  term.times_low = -1.0;
  term.times_high = 1.0;
  term.at = {-2.0, 0.0, 2.0};
  term.values = {-0.25, 0.0, 0.05};
  finding.identified.model.vehicle.unnamed = {term};
  UnnamedFinding found{"unnamed_1", 120.0, 20.0, {0.02, 0.0, 0.01}, {}};
  AtlasCell cell;
  cell.from = -2.0;
  cell.to = -1.0;
  cell.mean = -0.2;
  cell.rows = 40;
  found.data = {cell};
  finding.identified.unnamed = {found};
  const std::string text = markdownOf(reportPage(finding, samples::inputs()));
  CHECK(
      has(text, "unnamed_1: yaw rate added to the model, by change of |yaw rate|, times yaw rate"));
  CHECK(has(text, "-0.250 to 0.0500 rad/s per rad/s"));
  CHECK(has(text, "tread-gap name model.yaml unnamed_1 YOUR_NAME"));
  const std::string page = htmlOf(reportPage(finding, samples::inputs()));
  CHECK(unbalanced(page) == "");
  CHECK(has(page, "unnamed_1: yaw rate by change of |yaw rate|, times yaw rate"));
  CHECK(has(closingLines(finding)[1], "unnamed_1"));
  const auto json = verdictJson(finding, samples::inputs());
  REQUIRE(json["unnamed"].size() == 1);
  CHECK(json["unnamed"][0]["condition"] == "change of |yaw rate|");
  CHECK(json["unnamed"][0]["deviations"][0] == 0.02);
  const ModelDocument model = newModel(finding, samples::inputs());
  CHECK(parseModelDocument(formatModelDocument(model), "m").vehicle.unnamed[0].values ==
        term.values);
}

TEST_CASE("working on the same log again counts the runs") {
  GapFinding finding = samples::finding(GapVerdict::kFound);
  finding.before = newModel(finding, samples::inputs());
  CHECK(newModel(finding, samples::inputs()).provenance.runs == 2);
}

TEST_CASE("numbers are said with three digits that count and in the field's units") {
  CHECK(threeDigits(0.012345) == "0.0123");
  CHECK(threeDigits(1234.4) == "1234");
  CHECK(threeDigits(2.0) == "2");
  CHECK(threeDigits(100.0 * 0.07) == "7");
  CHECK(threeDigits(-1e-15) == "0");
  CHECK(threeDigits(kNotMeasured) == "-");
  CHECK(said(0.05, "rad") == "2.86 deg");
  CHECK(said(0.031, "1") == "3.10 %");
  CHECK(said(std::numeric_limits<double>::infinity(), "rad/s") == "no limit");
}

}  // namespace tread::gap
