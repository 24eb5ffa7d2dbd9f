// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cstdio>
#include <exception>

#include "common/config/command_line.hpp"
#include "tools/gap/commands.hpp"

int main(int argc, char** argv) {
  int status = 0;
  try {
    CLI::App app{"Finds, names and closes the gap between simulation and measurement.",
                 "tread-gap"};
    app.require_subcommand(1);
    tread::gap::addFind(app, status);
    tread::gap::addExplain(app);
    tread::gap::addWhatIf(app);
    tread::gap::addPlan(app, status);
    tread::gap::addCompare(app, status);
    if (const auto code = tread::parseCommandLine(app, argc, argv)) return *code;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tread-gap: %s\n", error.what());
    return tread::gap::kBadInput;
  }
  return status;
}
