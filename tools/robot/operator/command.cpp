// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/operator/command.hpp"

#include <csignal>
#include <cstdlib>
#include <iostream>

#include <sys/ioctl.h>
#include <unistd.h>

#include "common/bus/key_option.hpp"
#include "common/bus/lcm_bus.hpp"
#include "common/config/command_line.hpp"
#include "common/config/problem_words.hpp"
#include "common/seal/key_file.hpp"
#include "tools/robot/launch/running_robots.hpp"

namespace tread::operators {
namespace {

// A signal handler can reach nothing but a global; it lives in this file only.
volatile std::sig_atomic_t g_interrupted = 0;

void noteSignal(int /*signal*/) {
  g_interrupted = 1;
}

constexpr int kStepMs = 20;
constexpr size_t kLongestWhy = 500;  // [bytes] a stop must stay short enough to be sent

void show(const CommandOptions& options, const std::string& words) {
  if (!options.one_line) {
    std::cout << words << std::endl;
    return;
  }
  winsize size{};
  const bool known = ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
  std::cout << "\r\x1b[K" << (known ? words.substr(0, size.ws_col - 1U) : words) << std::flush;
}

int run(const std::string& name, const CommandOptions& options, Bus& bus, Call& call,
        const std::function<void(int)>& wait) {
  const int64_t begun = bus.now();
  int64_t next_line = begun;
  std::string told;
  while (g_interrupted == 0) {
    const int64_t now = bus.now();
    const CallResult result = call.step(now);
    const bool late =
        options.timeout > 0.0 && static_cast<double>(now - begun) * 1e-6 > options.timeout;
    if (result != CallResult::kPending || late) {
      if (result != CallResult::kDone) call.cancel(now);
      call.letGo(now);
      if (options.one_line) std::cout << std::endl;
      (result == CallResult::kDone ? std::cout : std::cerr)
          << name << ": " << (late ? "out of time: " : "") << call.describe(now) << std::endl;
      return result == CallResult::kDone ? 0 : 1;
    }
    if (const std::string notice = call.notice(); notice != told) {
      if (!notice.empty()) std::cout << name << ": " << notice << std::endl;
      told = notice;
    }
    if (options.progress > 0.0 && now >= next_line) {
      show(options, call.describe(now));
      next_line = now + static_cast<int64_t>(options.progress * 1e6);
    }
    wait(kStepMs);
  }
  call.cancel(bus.now());
  call.letGo(bus.now());
  if (options.one_line) std::cout << std::endl;
  std::cerr << name << ": interrupted" << std::endl;
  return 130;
}

}  // namespace

int runCall(const std::string& name, const CommandOptions& options,
            const std::function<std::unique_ptr<Call>(Bus&)>& make) {
  for (const int number : {SIGINT, SIGTERM}) std::signal(number, noteSignal);
  // A program started under nohup outlives its terminal.
  for (const int number : {SIGHUP, SIGQUIT})
    if (std::signal(number, noteSignal) == SIG_IGN) std::signal(number, SIG_IGN);
  try {
    const launch::RunningRobot robot = launch::findRobot(options.lcm_url, options.key);
    // On the robot's own host session and time stamp already reject recorded messages.
    LcmBus bus(
        BusAccess{robot.lcm_url, robot.here ? hostSealer(robot.key) : stationSealer(robot.key)},
        TimeSource::kHost);
    const std::unique_ptr<Call> call = make(bus);
    if (options.holds && std::getenv("SSH_CONNECTION") != nullptr)
      std::cerr << name
                << ": started over ssh: the robot does not notice when that connection is lost; "
                   "run it on your own machine, with the robot's key"
                << std::endl;
    return run(name, options, bus, *call, [&bus](int ms) { bus.handle(ms); });
  } catch (const std::exception& error) {
    std::cerr << name << ": " << wordsOf(error) << std::endl;
    return 1;
  }
}

int runPermissionCommand(int argc, char** argv, const PermissionCommand& command) {
  CLI::App app{command.description, command.name};
  CommandOptions options;
  Requester requester;
  requester.by = requester.operator_name = operatorName();
  double patience = 5.0;
  app.add_option("--by", requester.by, "who " + command.verb + ", for the log")
      ->capture_default_str();
  app.add_option("--operator", requester.operator_name, kOperatorHelp)->capture_default_str();
  app.add_option("--why", requester.why, "why, for the log")->check([](const std::string& why) {
    return why.size() <= kLongestWhy ? std::string() : std::string("--why: at most 500 bytes");
  });
  command.more(app);
  app.add_option("--timeout", patience, "how long to try [s]")->check(CLI::Range(0.5, 600.0));
  app.add_option("--lcm-url", options.lcm_url, kUrlHelp);
  addKeyOption(app, options.key, command.empty_key);
  if (const auto code = parseCommandLine(app, argc, argv)) return *code;
  return runCall(command.name, options,
                 [&](Bus& bus) { return command.make(bus, requester, patience); });
}

}  // namespace tread::operators
