// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cstdio>

#include <CLI/CLI.hpp>

#include "common/bus/channels.hpp"
#include "common/config/command_line.hpp"
#include "common/config/outputs.hpp"
#include "tools/robot/export/csv_export.hpp"
#include "tools/robot/export/mcap_export.hpp"

namespace {

using namespace tread;
using namespace tread::exporting;

struct Arguments {
  std::vector<std::string> logs;
  std::string output;
  std::string format;
  std::vector<std::string> channels;
  Selection selection;
  bool no_scene = false;
};

bool endsWith(const std::string& text, const std::string& ending) {
  return text.size() >= ending.size() &&
         text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

int run(Arguments& arguments) {
  arguments.selection.channels.insert(arguments.channels.begin(), arguments.channels.end());
  std::string format = arguments.format;
  if (format.empty()) format = endsWith(arguments.output, ".mcap") ? "mcap" : "csv";
  const ExportCounts counts =
      format == "mcap"
          ? exportMcap(arguments.logs, arguments.selection, arguments.output, !arguments.no_scene)
          : exportCsv(arguments.logs, arguments.selection, arguments.output);
  int64_t messages = 0;
  for (const auto& [channel, written] : counts.written) messages += written;
  std::printf("%s: %lld messages on %zu channels\n", arguments.output.c_str(),
              static_cast<long long>(messages), counts.written.size());
  for (const auto& [what, count] : counts.left_out)
    std::printf("left out: %lld on %s\n", static_cast<long long>(count), what.c_str());
  if (!counts.problem.empty()) std::printf("%s\n", counts.problem.c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Writes a log in a form that other programs open: MCAP (Foxglove, Lichtblick) or CSV "
      "(spreadsheets, pandas, MATLAB).",
      "tread-export"};
  Arguments arguments;
  app.add_option("logs", arguments.logs, "LCM log; several are parts of one recording, in order")
      ->required();
  Outputs(app)
      .fileOrFolder("-o,--output", arguments.output,
                    "FILE.mcap, or a folder for CSV files, one a channel")
      ->required();
  app.add_option("--format", arguments.format, "default: by the output's name")
      ->check(CLI::IsMember({"mcap", "csv"}));
  std::vector<std::string> names;
  for (const ChannelSpec& channel : kChannels) names.push_back(channel.name);
  app.add_option("--channels", arguments.channels, "only these channels, for instance INS,MOTOR")
      ->delimiter(',')
      ->check(CLI::IsMember(names));
  app.add_option("--from", arguments.selection.from, "[s] since the log began");
  app.add_option("--to", arguments.selection.to, "[s] since the log began");
  app.add_flag("--no-scene", arguments.no_scene,
               "MCAP without the drawings for viewers: robot, map, plan, events");
  if (const auto code = parseCommandLine(app, argc, argv)) return *code;
  return runProgram("tread-export", [&] { return run(arguments); });
}
