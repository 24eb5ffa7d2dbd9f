// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "common/bus/bus.hpp"
#include "common/bus/key_option.hpp"
#include "tools/robot/operator/calls.hpp"

namespace tread::operators {

/// Help of --lcm-url.
inline constexpr const char* kUrlHelp =
    "LCM provider; default: LCM_DEFAULT_URL, else the robot that tread-launch runs here";

/// Help of --operator.
inline constexpr const char* kOperatorHelp =
    "name of the operator; programs with the same name hold the robot together";

/// Options of a command that runs a call.
struct CommandOptions {
  std::string lcm_url;    ///< empty = searched, see launch::findRobot()
  std::string key;        ///< file of the robot's key; empty = messages are not sealed
  double timeout = 0.0;   ///< [s] after which the call is cancelled; 0 = never
  double progress = 0.0;  ///< [s] between lines of progress; 0 = none
  bool one_line = false;  ///< progress overwrites its line
  bool holds = false;     ///< the robot moves as long as the program runs
};

/// Runs a call over LCM until it ends, times out, or a signal ends it in good order.
/** Exit code: 0 done; 1 refused, timed out or LCM unusable, with one clear line; 130 interrupted.
 */
int runCall(const std::string& name, const CommandOptions& options,
            const std::function<std::unique_ptr<Call>(Bus&)>& make);

/// The differences of tread-arm and tread-stop.
struct PermissionCommand {
  std::string name;
  std::string description;
  std::string verb;                     ///< verb for messages: "arms"
  std::function<void(CLI::App&)> more;  ///< adds its own options
  /// `patience` [s].
  std::function<std::unique_ptr<Call>(Bus&, const Requester&, double patience)> make;
  EmptyKey empty_key = EmptyKey::kIsRefused;
};
/// The main function of tread-arm and tread-stop.
int runPermissionCommand(int argc, char** argv, const PermissionCommand& command);

}  // namespace tread::operators
