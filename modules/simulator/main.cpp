// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <iostream>
#include <optional>

#include "common/bus/shell.hpp"
#include "common/link/make_link.hpp"
#include "modules/simulator/model_vehicle.hpp"
#include "modules/simulator/simulator_files.hpp"
#include "modules/simulator/simulator_node.hpp"

namespace {

using namespace tread;
using namespace tread::sim;

/// Throws if a line cannot be offered, perhaps because of another simulator. A line without a user
/// is no fault.
void mustOffer(const Link& line) {
  const std::string problem = line.problem();
  if (!problem.empty() && problem.find("nobody has connected") == std::string::npos)
    throw std::runtime_error(problem + "; is another simulator running?");
}

ShellBody prepare(ConfigReader& reader) {
  const SimulatorConfig config = readSimulatorConfig(reader);
  const auto world = std::make_shared<const World>(readWorld(config.world));
  const auto run = [config, world](BusAccess access, const std::atomic<bool>& stop) {
    LcmBus bus(std::move(access), TimeSource::kHost);
    SimulatorSettings settings = config.settings;
    settings.robot.start_utime = bus.now();
    settings.ins.utc_at_zero = bus.utc() - bus.now();
    SimulatedDevices devices(world, settings,
                             config.model ? partsOf(*config.model, settings.robot) : RobotParts{});
    const std::unique_ptr<Link> ins = makeLink(config.ins);
    const std::unique_ptr<Link> motor = makeLink(config.motor);
    const std::unique_ptr<Link> laser = makeLink(config.laser);
    for (const Link* line : {ins.get(), motor.get(), laser.get()}) mustOffer(*line);
    std::unique_ptr<Link> ground_laser;
    if (settings.robot.ground_laser) mustOffer(*(ground_laser = makeLink(config.ground_laser)));
    std::optional<TruthRecord> record;
    if (config.record != "none") record.emplace(config.record);
    SimulatorNode node(devices, bus, DeviceLines{*ins, *motor, laser.get(), ground_laser.get()},
                       record ? &*record : nullptr, [](const std::string& line) {
                         std::cerr << "tread-simulator: " << line << std::endl;
                       });
    bus.run(node, stop);
  };
  return {run, [config] {
            requireListening(config.laser);
            if (config.settings.robot.ground_laser) requireListening(config.ground_laser);
          }};
}

}  // namespace

int main(int argc, char** argv) {
  return runShell(argc, argv, "tread-simulator",
                  "The simulated robot behind its devices' protocols: INS and motor controller on "
                  "pseudo-terminals, range finder on a TCP port. The configuration's model: FILE "
                  "simulates a model file instead of the dynamic vehicle; vehicle: changes the "
                  "latter's physical parameters.",
                  prepare);
}
