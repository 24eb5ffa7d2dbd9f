// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <iostream>
#include <optional>

#include <CLI/CLI.hpp>

#include "common/config/command_line.hpp"
#include "common/config/outputs.hpp"
#include "common/store/store.hpp"
#include "tools/robot/why/debrief.hpp"

namespace {

using namespace tread;
using namespace tread::why;

struct Arguments {
  std::vector<std::string> logs;
  double at = -1.0;
  std::string against;
  std::string html;
  std::string json;
};

int run(const Arguments& arguments) {
  const Debrief drive = debrief(readTimeline(arguments.logs, kInsStep));
  std::optional<Debrief> other;
  if (!arguments.against.empty()) other = debrief(readTimeline({arguments.against}, kInsStep));
  const Debrief* const before = other ? &*other : nullptr;
  std::cout << textOf(drive, arguments.at);
  if (before != nullptr) std::cout << "\n" << textOfDifferences(*before, drive);
  if (!arguments.html.empty()) writeText(arguments.html, htmlOf(drive, before));
  if (!arguments.json.empty()) writeText(arguments.json, jsonOf(drive, before));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Explains a drive from its LCM log: each stop, detour, refusal and surprise with its cause, "
      "its evidence and the time to inspect.",
      "tread-why"};
  Arguments arguments;
  app.add_option("logs", arguments.logs, "LCM log; several are parts of one recording, in order")
      ->required();
  app.add_option("--at", arguments.at,
                 "only findings within 5 s of this time [s since the log began]")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--against", arguments.against,
                 "another log: lists the differences of drive and configuration");
  Outputs outputs(app);
  outputs.file("--html", arguments.html, "also write the findings to this HTML file");
  outputs.file("--json", arguments.json, "also write all findings to this JSON file");
  if (const auto code = parseCommandLine(app, argc, argv)) return *code;
  return runProgram("tread-why", [&] { return run(arguments); });
}
