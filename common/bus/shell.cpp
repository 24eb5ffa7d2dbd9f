// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/bus/shell.hpp"

#include <sys/prctl.h>
#include <unistd.h>

#include <csignal>
#include <iostream>
#include <vector>

#include "common/bus/key_option.hpp"
#include "common/config/command_line.hpp"
#include "common/config/problem_words.hpp"
#include "common/seal/key_file.hpp"

namespace tread {
namespace {

// A signal handler can access only globals; this one is local to this file.
std::atomic<bool> g_stop{false};

void requestStop(int /*signal*/) {
  g_stop = true;
}

struct Arguments {
  std::string config_path;
  std::string lcm_url;
  std::string key;
  std::vector<std::string> overrides;
  bool check = false;
  bool with_parent = false;
};

void describe(CLI::App& app, Arguments& arguments) {
  app.add_option("--config", arguments.config_path, "configuration file (YAML)");
  app.add_option("--set", arguments.overrides, "KEY=VALUE: replaces a value of the configuration")
      ->expected(1)
      ->take_all();
  app.add_option("--lcm-url", arguments.lcm_url,
                 "LCM provider, for instance udpm://239.255.76.67:7667?ttl=0");
  addKeyOption(app, arguments.key);
  app.add_flag(
      "--check", arguments.check,
      "only read the configuration and the key, and print the effective values, defaults included");
  app.add_flag("--with-parent", arguments.with_parent, "end when the starting process is gone");
}

}  // namespace

const std::atomic<bool>& stopRequest(pid_t parent) {
  std::signal(SIGINT, requestStop);
  std::signal(SIGTERM, requestStop);
  // A closed terminal ends the process, unless nohup is used.
  if (std::signal(SIGHUP, requestStop) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
  // A device that vanishes during a write must not end the process.
  std::signal(SIGPIPE, SIG_IGN);
  // Nor may a file size limit: the write fails and is reported.
  std::signal(SIGXFSZ, SIG_IGN);
  if (parent != 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGINT);
    // It may be gone already.
    if (::getppid() != parent) g_stop = true;
  }
  return g_stop;
}

int runShell(int argc, char** argv, const std::string& name, const std::string& description,
             const ShellPreparation& prepare) {
  const pid_t parent = ::getppid();
  CLI::App app{description, name};
  Arguments arguments;
  describe(app, arguments);
  if (const auto code = parseCommandLine(app, argc, argv)) return *code;
  const std::atomic<bool>& stop = stopRequest(arguments.with_parent ? parent : 0);
  try {
    ConfigReader reader =
        arguments.config_path.empty()
            ? ConfigReader::fromText("{}", "defaults (no --config)", arguments.overrides)
            : ConfigReader::fromFile(arguments.config_path, arguments.overrides);
    const ShellBody body = prepare(reader);
    BusAccess access{arguments.lcm_url, hostSealer(arguments.key)};
    if (arguments.check) {
      if (body.trial) body.trial();
      for (const std::string& warning : body.warnings)
        std::cout << "# warning: " << warning << '\n';
      std::cout << reader.effective();
    } else {
      body.run(std::move(access), stop);
    }
  } catch (const std::exception& error) {
    std::cerr << name << ": " << wordsOf(error) << std::endl;
    return 1;
  }
  return 0;
}

}  // namespace tread
