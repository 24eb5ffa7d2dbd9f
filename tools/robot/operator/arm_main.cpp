// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/operator/command.hpp"

int main(int argc, char** argv) {
  using namespace tread::operators;
  ArmOptions request;
  bool disarm = false;
  const auto addOptions = [&](CLI::App& app) {
    auto* off = app.add_flag("--disarm", disarm, "disarm: withdraw the permission to drive");
    auto* hold =
        app.add_flag("--hold", request.hold,
                     "keep running: the robot may drive only as long as this program runs");
    auto* next = app.add_option(
        "--hand-over", request.hand_over_to,
        "hand the robot that you hold over to this operator, whose program must be running");
    off->excludes(hold)->excludes(next);
    hold->excludes(next);
  };
  return runPermissionCommand(
      argc, argv,
      {"tread-arm",
       "Arms the robot: it may drive to goals given from now on, as long as an operator's "
       "program runs.",
       "arms", addOptions, [&](tread::Bus& bus, const Requester& requester, double patience) {
         request.arm = !disarm;
         return std::make_unique<ArmCall>(bus, requester, request, patience);
       }});
}
