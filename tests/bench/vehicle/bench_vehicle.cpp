// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "common/vehicle/effect_file.hpp"
#include "common/vehicle/effects.hpp"
#include "common/vehicle/kernel.hpp"

namespace {

using namespace tread;

VehicleModel plain(double step) {
  VehicleModel model;
  model.full_speed = 1.1;
  model.gauge = 0.6;
  model.lag = 0.15;
  model.delay = 0.08;
  model.step = step;
  return model;
}

void turnOn(const Effect& effect, VehicleModel& model) {
  for (const EffectParameter& parameter : effect.parameters)
    valueIn(model.effects, parameter) = parameter.typical;
}

VehicleModel everything(double step) {
  VehicleModel model = plain(step);
  for (const Effect& effect : effectCatalogue())
    if (effect.kind() == EffectKind::kVehicle) turnOn(effect, model);
  return model;
}

/// One iteration: one command of 50 ms.
void drive(benchmark::State& state, const VehicleModel& model) {
  const std::vector<TrackCommand> commands{{1.0, 1.0}, {0.2, 1.0}, {-0.5, 0.5}, {0.9, 0.7}};
  VehicleKernel kernel(model, {});
  size_t i = 0;
  for (auto _ : state) {
    kernel.step(commands[(i++ / 20) % commands.size()], 0.05);
    benchmark::DoNotOptimize(kernel.pose());
  }
}

}  // namespace

int main(int argc, char** argv) {
  for (const double step : {0.005, 0.025, 0.05}) {
    const std::string name = "/step " + std::to_string(static_cast<int>(1e3 * step)) + " ms";
    benchmark::RegisterBenchmark(("all off" + name).c_str(), drive, plain(step));
    benchmark::RegisterBenchmark(("all on" + name).c_str(), drive, everything(step));
  }
  addEffectsOf(TREAD_SOURCE_DIR "/config/effects");
  for (const Effect& effect : effectCatalogue()) {
    if (effect.kind() != EffectKind::kVehicle) continue;
    VehicleModel model = plain(0.005);
    turnOn(effect, model);
    benchmark::RegisterBenchmark(effect.name.c_str(), drive, model);
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
