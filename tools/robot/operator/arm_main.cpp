// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <CLI/CLI.hpp>

#include "common/config/command_line.hpp"
#include "tools/robot/operator/command.hpp"

int main(int argc, char** argv) {
  using namespace tread::operators;
  CLI::App app{"Arms the robot: it may drive from now on. Only an armed robot moves.", "tread-arm"};
  CommandOptions options;
  Requester requester;
  bool disarm = false;
  double patience = 5.0;
  app.add_option("--by", requester.by, "who arms");
  app.add_option("--why", requester.why, "why, for the log");
  app.add_flag("--disarm", disarm, "take the permission back");
  app.add_option("--timeout", patience, "how long to try [s]")->check(CLI::Range(0.5, 600.0));
  app.add_option("--lcm-url", options.lcm_url, "LCM provider");
  if (const auto code = tread::parseCommandLine(app, argc, argv)) return *code;
  return runCall("tread-arm", options, [&](tread::Bus& bus) {
    return std::make_unique<ArmCall>(bus, requester, !disarm, patience);
  });
}
