// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/hide/blind_case.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "modules/simulator/core/noise.hpp"
#include "tests/study/hide/bad_log.hpp"
#include "tests/study/hide/blind_log.hpp"
#include "tests/study/hide/instruments.hpp"
#include "tests/study/hide/truth_text.hpp"

namespace tread::blind {
namespace {

constexpr int64_t kInsPhases = 20;  // [ms]

Excitation excitationOf(const HiddenDrive& drive) {
  Excitation most;
  for (const Twist2& v : drive.track.v_clean) {
    most.speed = std::max(most.speed, std::abs(v.v_x));
    most.yaw_rate = std::max(most.yaw_rate, std::abs(v.omega));
    most.side_acceleration = std::max(most.side_acceleration, std::abs(v.v_x * v.omega));
  }
  const auto& patterns = drive.programme.patterns;
  for (size_t i = 1; i < patterns.size(); ++i) {
    const sim::MotorPower& a = patterns[i - 1].power;
    const sim::MotorPower& b = patterns[i].power;
    most.reversals += (a.left * b.left < 0.0) + (a.right * b.right < 0.0);
  }
  return most;
}

std::vector<HiddenTruth> truthOf(const std::vector<Hidden>& hidden, const Comparison& comparison) {
  std::vector<HiddenTruth> all;
  for (const Hidden& one : hidden) {
    HiddenTruth truth{one.spec, one.hider.levers, one.hider.equivalent, one.spec->group};
    for (const std::string& other : one.hider.unlike)
      truth.group.erase(std::remove(truth.group.begin(), truth.group.end(), other),
                        truth.group.end());
    if (one.hider.measure) truth.equivalent = one.hider.measure(comparison);
    all.push_back(truth);
  }
  return all;
}

/// A drive, its measurements, and the truth.
struct Driven {
  HiddenDrive drive;
  std::vector<sim::InsMeasurement> measured;
  CaseTruth truth;
};

Driven driveCase(const CasePlan& plan, const NoiseLevel& noise) {
  const Programme programme = makeProgramme(plan.choice, plan.minutes, plan.seed);
  const double duration = static_cast<double>(programme.duration) * 1e-6;
  const auto hidden = [&] { return makeHidden(plan.effects, plan.size, duration, plan.seed); };
  Driven driven;
  driven.drive = drive(programme, hidden(), noise, plan.seed);
  const InstrumentFault fault = faultOf(hidden());
  Rng rng(sim::streamSeed(plan.seed, kClockStream));
  const int64_t phase = 1000 * rng.below(kInsPhases);
  driven.measured = measure(driven.drive.track, fault, noise, plan.seed, phase);
  CaseTruth& truth = driven.truth;
  truth.duration = duration;
  truth.floor = oracleFloor(driven.drive, fault, driven.measured);
  truth.excitation = excitationOf(driven.drive);
  if (plan.effects.empty()) return driven;
  // Each effect is measured alone relative to the plain vehicle; the gap is that of all together.
  const HiddenDrive plain = drive(programme, {}, noise, plan.seed);
  truth.gap = hiddenGap(driven.drive, fault, plain);
  for (const std::string& effect : plan.effects) {
    const auto alone = [&] { return makeHidden({effect}, plan.size, duration, plan.seed); };
    const bool only = plan.effects.size() == 1;
    const Comparison comparison =
        compare(only ? driven.drive : drive(programme, alone(), noise, plan.seed), plain);
    for (const HiddenTruth& one : truthOf(alone(), comparison)) truth.effects.push_back(one);
  }
  return driven;
}

}  // namespace

std::string kindName(CaseKind kind) {
  switch (kind) {
    case CaseKind::kSingle:
      return "single";
    case CaseKind::kPair:
      return "pair";
    case CaseKind::kUnknown:
      return "out_of_catalogue";
    case CaseKind::kDegenerate:
      return "degenerate";
    case CaseKind::kBad:
      return "bad";
    case CaseKind::kNull:
      break;
  }
  return "null";
}

MadeCase makeCase(const CasePlan& plan) {
  const auto noise = noiseLevel(plan.noise);
  if (!noise) throw std::invalid_argument("noise '" + plan.noise + "' is not low, mid or high");
  Driven driven = driveCase(plan, *noise);
  MadeCase made;
  made.events = makeLog(driven.drive, driven.measured, plan.name, plan.seed);
  if (!plan.defect.empty()) {
    std::vector<LogEvent> other;
    if (plan.defect == "two_robots") {
      CasePlan second = plan;
      second.defect.clear();
      second.seed = sim::streamSeed(plan.seed, kSecondRobotStream);
      const Driven robot = driveCase(second, *noise);
      other = makeLog(robot.drive, robot.measured, plan.name, second.seed);
    }
    const Defect defect = spoil(plan.defect, plan.seed, other, made.events);
    made.keep = defect.keep;
    driven.truth.defect_at = defect.where;
  }
  made.truth = truthText(plan, driven.truth);
  return made;
}

}  // namespace tread::blind
