// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cstdio>

#include "common/config/command_line.hpp"
#include "tools/robot/patterns/commands.hpp"
#include "tools/robot/patterns/from_recordings_command.hpp"
#include "tools/robot/patterns/recipe_command.hpp"
#include "tools/robot/patterns/recording_commands.hpp"
#include "tools/robot/patterns/set_commands.hpp"

int main(int argc, char** argv) {
  return tread::runProgram("tread-patterns", [&] {
    CLI::App app{"Makes, records, averages, shows and checks motion patterns."};
    app.require_subcommand(1);
    tread::patterns::addRecipe(app);
    tread::patterns::addMake(app);
    tread::patterns::addRecord(app);
    tread::patterns::addFromRecordings(app);
    tread::patterns::addAverage(app);
    tread::patterns::addShow(app);
    tread::patterns::addCheck(app);
    tread::patterns::addMirror(app);
    try {
      return tread::parseCommandLine(app, argc, argv).value_or(0);
    } catch (const tread::patterns::RecordingStopped& stopped) {
      std::fprintf(stderr, "tread-patterns: %s\n", stopped.what());
      return 1;
    }
  });
}
