// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/operator/command.hpp"

int main(int argc, char** argv) {
  using namespace tread::operators;
  bool clear = false;
  return runPermissionCommand(
      argc, argv,
      {"tread-stop", "Emergency stop over LCM. It does not replace the button on the machine.",
       "stops",
       [&](CLI::App& app) {
         app.add_flag("--clear", clear, "clear the stop; the robot must still be armed afterwards");
       },
       [&](tread::Bus& bus, const Requester& requester, double patience) {
         return std::make_unique<StopCall>(bus, requester, !clear, patience);
       },
       tread::EmptyKey::kIsNone});
}
