// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/operator/command.hpp"

int main(int argc, char** argv) {
  using namespace tread::operators;
  return runPermissionCommand(
      argc, argv,
      {"tread-arm", "Arms the robot: it may drive from now on. Only an armed robot moves.", "arms",
       "--disarm", "take the permission back",
       [](tread::Bus& bus, const Requester& requester, bool given, double patience) {
         return std::make_unique<ArmCall>(bus, requester, given, patience);
       }});
}
