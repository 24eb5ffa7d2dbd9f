// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/gap/watch_command.hpp"

#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/bus/key_option.hpp"
#include "common/bus/shell.hpp"
#include "common/seal/key_file.hpp"
#include "tools/lab/gap/question_commands.hpp"
#include "tools/lab/gap/watch.hpp"
#include "tools/lab/gap/watch_node.hpp"

namespace tread::gap {
namespace {

constexpr int kSomethingNew = 10;

struct WatchOptions {
  std::string model;
  std::vector<std::string> logs;
  std::string lcm_url;
  std::string key;
  WatchLimits limits;
};

int watchLogs(const WatchOptions& options, const ModelDocument& model) {
  const DriveLog log = readDriveLog(options.logs);
  WatchedDrive drive(model, options.limits);
  bool anything = false;
  for (const LogEvent& event : log.events)
    if (const auto line = drive.take(event)) {
      std::cout << line->text << std::endl;
      anything = true;
    }
  const auto seconds = static_cast<int64_t>(drive.compared());
  if (seconds == 0)
    throw std::runtime_error(
        log.damage.empty()
            ? options.logs.front() +
                  ": less than ten seconds of driving with INS and MOTOR; give a log "
                  "of a drive"
            : log.damage);
  if (!log.damage.empty()) std::cout << log.damage << '\n';
  if (!anything) std::cout << "nothing new in " << seconds << " s of driving" << std::endl;
  return anything ? kSomethingNew : 0;
}

int watchRobot(const WatchOptions& options, const ModelDocument& model) {
  LcmBus bus({options.lcm_url, hostSealer(options.key)}, TimeSource::kFollow);
  WatchNode node(bus, model, options.limits);
  bus.run(node, stopRequest(0));
  return node.anything() ? kSomethingNew : 0;
}

}  // namespace

void addWatch(CLI::App& app, int& status) {
  const auto options = std::make_shared<WatchOptions>();
  CLI::App* command = app.add_subcommand(
      "watch", "compare a driving robot with its model and report new differences, one line each");
  command->footer(
      "Reads INS and MOTOR from the bus and compares the last seconds of driving with the model:\n"
      "the speed of each drive, the turning, the delay of commands. A lasting change is reported "
      "once, "
      "on\n"
      "the terminal, in HEALTH of gap_watch and as a MARK in the log. With LOGS it reads a\n"
      "recording instead. On another ground than the model's both drives and the turning differ: "
      "use a\n"
      "model of that ground. Exit status: 0 nothing new, 10 something, 2 bad "
      "input.");
  command->add_option("LOGS", options->logs,
                      "LCM logs instead of the bus; several are parts of one recording");
  command->add_option("--model", options->model, "model file (YAML)")->required();
  command->add_option("--least", options->limits.gain, "smaller changes of a gain are ignored [1]")
      ->capture_default_str()
      ->check(CLI::Range(0.005, 0.5));
  command
      ->add_option("--hours", options->limits.hours,
                   "least mean driving time between false alarms [h]")
      ->capture_default_str()
      ->check(CLI::Range(1.0, 1e6));
  command->add_option("--lcm-url", options->lcm_url, "LCM provider");
  addKeyOption(*command, options->key);
  command->callback([options, &status] {
    const ModelDocument model = readTwoTracks(options->model, "watch");
    status = options->logs.empty() ? watchRobot(*options, model) : watchLogs(*options, model);
  });
}

}  // namespace tread::gap
