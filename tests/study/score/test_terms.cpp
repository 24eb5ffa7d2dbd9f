// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The truth uses the catalogue's terms: names, signs, parameters, similar effects.
#include <algorithm>
#include <set>

#include <catch2/catch.hpp>

#include "common/vehicle/effects.hpp"
#include "common/vehicle/kernel.hpp"
#include "common/vehicle/model_document.hpp"
#include "tests/study/hide/effect_list.hpp"
#include "tests/study/hide/instruments.hpp"
#include "tests/study/hide/semi.hpp"
#include "tests/study/score/judgement.hpp"

using namespace tread;
using blind::EffectSpec;
using Names = std::set<std::string>;

namespace {

Names setOf(const std::vector<std::string>& names) {
  return {names.begin(), names.end()};
}

/// Effects of the catalogue that are not combinations.
std::vector<const EffectSpec*> listed() {
  std::vector<const EffectSpec*> specs;
  for (const EffectSpec& spec : blind::effectList())
    if (spec.kind == blind::EffectKind::kVehicle || spec.kind == blind::EffectKind::kMeasurement ||
        spec.kind == blind::EffectKind::kVehicleVariant)
      specs.push_back(&spec);
  return specs;
}

/// A drive on varying arcs, every 10 ms.
std::vector<Pose2> winding() {
  std::vector<Pose2> poses;
  Pose2 pose;
  for (int i = 0; i < 2000; ++i) {
    poses.push_back(pose);
    const double time = 0.01 * i;
    const double v = 0.6 + 0.4 * std::sin(0.7 * time), omega = 0.8 * std::sin(0.4 * time);
    pose.x += 0.01 * v * std::cos(pose.yaw);
    pose.y += 0.01 * v * std::sin(pose.yaw);
    pose.yaw += 0.01 * omega;
  }
  return poses;
}

}  // namespace

TEST_CASE("what is hidden is in the catalogue, and its numbers have parameters there") {
  for (const EffectSpec* spec : listed()) {
    CAPTURE(spec->name);
    const Effect& effect = effectNamed(spec->name);
    const bool measurement = spec->kind == blind::EffectKind::kMeasurement;
    CHECK((effect.kind() == EffectKind::kMeasurement) == measurement);
    for (const blind::Hidden& one : blind::makeHidden({spec->name}, 2.0, 600.0, 1))
      for (const blind::Quantity& number : one.hider.equivalent)
        if (const auto same = blindtest::sameQuantity(spec->name, number.name, 600.0))
          CHECK(std::any_of(effect.parameters.begin(), effect.parameters.end(),
                            [&](const EffectParameter& parameter) {
                              return parameter.name == same->parameter ||
                                     parameter.natural_name == same->parameter;
                            }));
  }
}

TEST_CASE(
    "the INS of the generator errs as the catalogue's measurement effect of the same number") {
  const std::vector<Pose2> poses = winding();
  std::vector<MotionSample> motion;
  for (size_t i = 0; i < poses.size(); ++i)
    motion.push_back({0.01 * static_cast<double>(i), poses[i], 0.0});
  int compared = 0;
  for (const EffectSpec& spec : blind::effectList()) {
    if (spec.kind != blind::EffectKind::kMeasurement) continue;
    CAPTURE(spec.name);
    for (const uint64_t seed : {1, 2, 3}) {
      const auto hidden = blind::makeHidden({spec.name}, 2.0, 600.0, seed);
      const blind::Quantity number = hidden.front().hider.equivalent.front();
      const auto same = blindtest::sameQuantity(spec.name, number.name, 600.0);
      REQUIRE(same);
      CHECK(same->factor == 1.0);
      ModelDocument model;
      *findParameter(model, std::string(spec.name) + "." + same->parameter) = number.value;
      for (const double time : {3.0, 7.77, 12.5}) {
        const Pose2 wanted = measuredAt(motion, model.measurement, time).T_map_body;
        const Pose2 said = blind::sensedPose(poses, blind::faultOf(hidden), time);
        CHECK(said.x == Approx(wanted.x).margin(1e-4));
        CHECK(said.y == Approx(wanted.y).margin(1e-4));
        CHECK(said.yaw == Approx(wanted.yaw).margin(1e-4));
        ++compared;
      }
    }
  }
  CHECK(compared == 7 * 9);
}

TEST_CASE("what no drive can tell apart is alike for the generator and for the workflow") {
  for (const EffectSpec* spec : listed()) {
    CAPTURE(spec->name);
    Names alike;
    std::vector<Names> together;
    for (const ConfoundedGroup* group : confoundedGroupsOf(spec->name)) {
      // Two against two: hidden alone, as in the study, each is distinguished from the others by a
      // stop.
      if (group->together) continue;
      Names others = setOf(group->members);
      others.erase(spec->name);
      // The study hides effects in vehicles on tracks alone.
      for (const std::string& member : group->members) {
        const Effect* const effect = findEffect(member);
        if (effect != nullptr && !effect->isOf(VehicleLayout::kTracks)) others.erase(member);
      }
      // A delay is a latency of all channels; one of the poses alone is not.
      const bool late = group->name == "late" && spec->name == std::string("command_delay");
      if (group->name == "scale")
        together.push_back(others);
      else if (group->when.empty() || late || group->name == "payload_or_ground")
        alike.insert(others.begin(), others.end());
    }
    CHECK(setOf(spec->group) == alike);
    REQUIRE(spec->together.size() == together.size());
    for (size_t i = 0; i < together.size(); ++i) CHECK(setOf(spec->together[i]) == together[i]);
  }
}

TEST_CASE("the truth of a case in a recording can be scored") {
  for (const blind::SemiEffect& effect : blind::semiEffects()) {
    CAPTURE(effect.name);
    const blind::SemiTruth truth{effect.name, {{effect.parameter, effect.small, "", false}}, 300.0};
    nlohmann::ordered_json line;
    line["case"] = "r0001";
    line["truth"] = nlohmann::ordered_json::parse(blind::semiTruthText("r0001", truth, 1, 1, ""));
    line["nominal"] = nlohmann::ordered_json::object();
    line["answer"] = {{"exit", 2}, {"message", "x"}, {"verdict", nullptr}};
    blindtest::CaseRecord record = blindtest::recordOf(line);
    CHECK(record.truth.duration == 300.0);
    CHECK_FALSE(blindtest::judge(record).first_right);
    record.answer.verdict = "FOUND";
    record.answer.effects.push_back({effect.name, {}, {}, {}});
    CHECK(blindtest::judge(record).first_right);
    CHECK(blindtest::judge(record).excited);
  }
}
