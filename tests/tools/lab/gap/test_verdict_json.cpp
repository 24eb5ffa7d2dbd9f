// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "tests/tools/lab/gap/sample_findings.hpp"
#include "tools/lab/gap/report/find_output.hpp"

namespace tread::gap {

using Json = nlohmann::ordered_json;

TEST_CASE("verdict.json names the verdict, and the verdict is the exit status") {
  const std::pair<GapVerdict, int> kExpected[] = {
      {GapVerdict::kNoDiscrepancy, 0}, {GapVerdict::kNothingNew, 0},
      {GapVerdict::kFound, 10},        {GapVerdict::kAmbiguous, 11},
      {GapVerdict::kPartial, 12},      {GapVerdict::kNotInCatalogue, 13},
      {GapVerdict::kMeasurement, 14},  {GapVerdict::kCannotTell, 15}};
  const char* const kNames[] = {"NO_DISCREPANCY", "NOTHING_NEW",      "FOUND",       "AMBIGUOUS",
                                "PARTIAL",        "NOT_IN_CATALOGUE", "MEASUREMENT", "CANNOT_TELL"};
  for (size_t i = 0; i < 8; ++i) {
    const Json json = verdictJson(samples::finding(kExpected[i].first), samples::inputs());
    CHECK(json["verdict"] == kNames[i]);
    CHECK(exitStatus(kExpected[i].first) == kExpected[i].second);
    for (const char* key : {"cut_short", "effects", "calibrated", "gap", "unexplained",
                            "not_excited", "seed", "inputs"})
      CHECK(json.contains(key));
  }
}

TEST_CASE("an effect in verdict.json has kind, parameters, group and runner-ups") {
  const Json json = verdictJson(samples::finding(GapVerdict::kFound), samples::inputs());
  const Json& effect = json["effects"][0];
  CHECK(effect["name"] == "turn_power_limit");
  CHECK(effect["kind"] == "vehicle");
  CHECK(effect["group"].empty());
  CHECK(effect["runner_up"] == Json::array({"yaw_rate_skid"}));
  CHECK(verdictJson(samples::finding(GapVerdict::kMeasurement), {})["effects"][0]["kind"] ==
        "measurement");
  CHECK(verdictJson(samples::finding(GapVerdict::kAmbiguous), {})["effects"][0]["group"] ==
        Json::array({"lever_arm_x"}));
}

TEST_CASE("what the wheel speeds show of an effect is in verdict.json where they say something") {
  GapFinding finding = samples::finding(GapVerdict::kFound);
  finding.identified.effects[0].evidence.push_back({EvidenceSource::kWheels, 0.97, 0.9, 1.04});
  const Json json = verdictJson(finding, samples::inputs());
  CHECK(json["effects"][0]["wheel_speeds_show"] ==
        Json({{"share", 0.97}, {"low", 0.9}, {"high", 1.04}}));
  CHECK_FALSE(json["effects"][1].contains("wheel_speeds_show"));
}

TEST_CASE("so is what the motor currents and the battery voltage do with it") {
  GapFinding finding = samples::finding(GapVerdict::kFound);
  finding.identified.effects[0].evidence.push_back({EvidenceSource::kCurrents, 12.0, 10.0, 14.0});
  finding.identified.effects[0].evidence.push_back({EvidenceSource::kVoltage, 0.02, 0.0, 0.04});
  const Json json = verdictJson(finding, samples::inputs());
  const Json& effect = json["effects"][0];
  CHECK(effect["motor_currents_rise"] ==
        Json({{"rise", 12.0}, {"low", 10.0}, {"high", 14.0}, {"load", true}}));
  CHECK(effect["battery_voltage_falls"] ==
        Json({{"share", 0.02}, {"low", 0.0}, {"high", 0.04}, {"battery", false}}));
  finding.identified.effects[0].evidence.clear();
  finding.identified.effects[0].evidence.push_back({EvidenceSource::kCurrents, 1.0, 0.2, 1.8});
  finding.identified.effects[0].evidence.push_back({EvidenceSource::kVoltage, 0.5, 0.2, 0.8});
  const Json vague = verdictJson(finding, samples::inputs());
  CHECK(vague["effects"][0]["motor_currents_rise"]["load"].is_null());
  CHECK(vague["effects"][0]["battery_voltage_falls"]["battery"].is_null());
  for (const char* key : {"motor_currents_rise", "battery_voltage_falls"})
    CHECK_FALSE(json["effects"][1].contains(key));
}

TEST_CASE("a limit stands in verdict.json as its reciprocal and as itself") {
  const Json json = verdictJson(samples::finding(GapVerdict::kFound), samples::inputs());
  const Json& parameters = json["effects"][0]["parameters"];
  CHECK(parameters["inverse_limit"]["value"] == 0.8);
  CHECK(parameters["inverse_limit"]["unit"] == "s/rad");
  CHECK(parameters["limit"]["value"] == 1.25);
  CHECK(parameters["limit"]["unit"] == "rad/s");
  CHECK(parameters["limit"]["low"].get<double>() == Approx(1.0 / 0.82));
  CHECK(parameters["limit"]["high"].get<double>() == Approx(1.0 / 0.78));
}

TEST_CASE("numbers in verdict.json that are not finite are null") {
  GapFinding finding = samples::finding(GapVerdict::kFound);
  finding.identified.effects[0].parameters[0].low = 0.0;  // possibly no limit at all
  finding.identified.effects[1].parameters[0].high = std::numeric_limits<double>::infinity();
  const Json json = verdictJson(finding, samples::inputs());
  CHECK(json["effects"][0]["parameters"]["limit"]["high"].is_null());
  CHECK(json["effects"][1]["parameters"]["share"]["high"].is_null());
  CHECK(Json::parse(json.dump()) == json);
}

TEST_CASE("verdict.json holds the gap before, after and at the floor, or null") {
  Json gap = verdictJson(samples::finding(GapVerdict::kFound), {})["gap"];
  CHECK(gap["horizon_s"] == 2.0);
  CHECK(gap["before"]["position_m"]["median"] == 0.642);
  CHECK(gap["after"]["yaw_rad"]["rms"] == 0.31);
  CHECK(gap["floor"]["position_m"]["median"] == 0.29);
  GapFinding without_floor = samples::finding(GapVerdict::kFound);
  without_floor.gap->floor.reset();
  CHECK(verdictJson(without_floor, {})["gap"]["floor"].is_null());
  gap = verdictJson(samples::finding(GapVerdict::kCannotTell), {})["gap"];
  CHECK(gap["before"].is_null());
}

TEST_CASE(
    "verdict.json names calibrated terms, what remains, what was not excited, and its files") {
  const Json json = verdictJson(samples::finding(GapVerdict::kPartial), samples::inputs());
  CHECK(json["calibrated"]["lag"]["value"] == 0.17);
  CHECK(json["calibrated"]["icr_offset.offset"]["unit"] == "m");
  CHECK(
      json["unexplained"][0] ==
      Json({{"channel", "yaw rate"}, {"variable", "speed x yaw rate"}, {"like", "yaw_rate_skid"}}));
  CHECK(json["not_excited"] == Json::array({"grip_limit", "slope_pitch"}));
  CHECK(json["seed"] == 7);
  CHECK(json["inputs"]["model"]["sha256"] == std::string(64, 'a'));
  CHECK(json["inputs"]["train"][0]["name"] == "a.lcmlog");
  CHECK(json["inputs"]["test"][0]["sha256"] == std::string(64, 'c'));
}

}  // namespace tread::gap
