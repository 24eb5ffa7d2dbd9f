// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Effects from files in the workflow. A separate program, as they are added to the global
// catalogue.
#include <cmath>
#include <string>
#include <utility>

#include <catch2/catch.hpp>

#include "common/config/config_reader.hpp"
#include "common/vehicle/effect_file.hpp"
#include "core_rig.hpp"
#include "modules/identification/core/discovery.hpp"

using namespace tread;
using namespace tread::gap;
using namespace tread::gap::samples;

namespace {

void add(const std::string& text) {
  ConfigReader reader = ConfigReader::fromText(text, "effect.yaml");
  EffectEntry entry = readEffectEntry(reader);
  addEntry(std::move(entry), reader);
}

GapFinding found(const Values& hidden, uint64_t seed) {
  GapTask task;
  task.model = syntheticVehicle();
  task.train = {syntheticDrive(vehicleWith(hidden), 400.0, seed)};
  return findGap(task, kSilent);
}

}  // namespace

TEST_CASE("a fit of an effect of a file is that of the same effect of the catalogue") {
  add("name: own_drag\ntitle: T\nsentence: S\nchannels: x\nchanges: v\n"
      "to: v - p * v * abs(v)\nparameters:\n"
      "  - {name: p, unit: s/m, min: -0.1, max: 0.5, typical: 0.05}\n"
      "looks_like: L\nseparates: S\ncheck: C\n");
  const Rig rig({{"quadratic_drag.drag", 0.15}}, 200.0, 11);
  const FitState builtin = rig.fitted({{"forward_gain", 0.95}, {"quadratic_drag.drag", 0.05}});
  const FitState own = rig.fitted({{"forward_gain", 0.95}, {"own_drag.p", 0.05}});
  const double size = *findParameter(builtin.model, "quadratic_drag.drag");
  CHECK(size == Approx(0.15).margin(0.03));
  CHECK(*findParameter(own.model, "own_drag.p") == Approx(size).epsilon(1e-6));
  CHECK(own.loss == Approx(builtin.loss).epsilon(1e-9));
}

TEST_CASE("the effects of config/effects are found by name, and not where they are not") {
  addEffectsOf(std::string(TREAD_SOURCE_DIR) + "/config/effects");
  CHECK(found({}, 31).identified.effects.empty());
  for (const auto& [path, value] : Values{{"motor_limit.right_backward", 2.0},
                                          {"yaw_windup.time", 0.3},
                                          {"centre_to_side.offset", 0.08}}) {
    INFO(path);
    const GapFinding finding = found({{path, value}}, 33);
    // An effect that no drive distinguishes from a lever arm of the INS may be named as such,
    // listed with it.
    const std::string name = effectOfPath(path);
    int named = 0;
    for (const FoundEffect& effect : finding.identified.effects) {
      INFO(effect.name);
      const double size = effect.parameters.front().value;
      if (effect.name == name || contains(effect.group, name)) {
        ++named;
        CHECK(std::abs(size) == Approx(value).epsilon(0.1));
      } else {
        // A memory is updated step by step: with the fit's longer steps it is some ms early.
        CHECK(effectNamed(effect.name).search.late_by == LateBy::kCommand);
        CHECK(std::abs(size) < 0.005);
      }
    }
    CHECK(named == 1);
  }
}
