// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <iostream>

#include <unistd.h>
#include <CLI/CLI.hpp>

#include "common/bus/key_option.hpp"
#include "common/config/command_line.hpp"
#include "tools/robot/drive/drive_call.hpp"
#include "tools/robot/drive/evdev_pad.hpp"
#include "tools/robot/drive/keyboard.hpp"
#include "tools/robot/operator/command.hpp"

namespace {

using namespace tread;
using namespace tread::drive;

struct StickOptions {
  std::string device;
  std::string events;
  bool keyboard = false;
};

std::unique_ptr<Stick> openStick(const StickOptions& options) {
  if (!options.events.empty()) return std::make_unique<RecordedPad>(options.events);
  const bool typed = options.device.empty() && ::isatty(STDIN_FILENO) == 1 && !padFound();
  if (options.keyboard || typed) return std::make_unique<Keyboard>();
  return std::make_unique<EvdevPad>(options.device);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Drives the robot by hand, with a gamepad, a joystick or the keyboard. Moving the stick "
      "takes "
      "the "
      "robot over from the planner; a button gives it back. Ctrl-C ends, and disarms a robot "
      "under manual control.",
      "tread-drive"};
  operators::CommandOptions options;
  options.holds = true;
  operators::Requester requester;
  requester.by = requester.operator_name = operatorName();
  requester.why = "driven by hand";
  StickOptions sticks;
  auto* device = app.add_option("--device", sticks.device,
                                "input device, as /dev/input/event7; else the first gamepad or "
                                "joystick, else the keyboard");
  auto* events =
      app.add_option("--events", sticks.events, "plays a device recording by evemu-record");
  auto* keyboard = app.add_flag("--keyboard", sticks.keyboard, "drive with the keyboard");
  device->excludes(events)->excludes(keyboard);
  events->excludes(keyboard);
  app.add_option("--operator", requester.operator_name, operators::kOperatorHelp)
      ->capture_default_str();
  app.add_option("--lcm-url", options.lcm_url, operators::kUrlHelp);
  addKeyOption(app, options.key);
  if (const auto code = parseCommandLine(app, argc, argv)) return *code;
  options.one_line = ::isatty(STDOUT_FILENO) == 1;
  options.progress = options.one_line ? 0.1 : 1.0;
  return operators::runCall("tread-drive", options, [&](Bus& bus) {
    std::unique_ptr<Stick> stick = openStick(sticks);
    std::cout << stick->name() << ": " << stick->keys() << std::endl;
    return std::make_unique<DriveCall>(bus, requester, std::move(stick));
  });
}
