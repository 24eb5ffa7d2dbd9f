// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/bus/shell.hpp"

#include <csignal>
#include <iostream>

#include <CLI/CLI.hpp>

namespace tread {
namespace {

// A signal handler can reach nothing but a global; it lives in this file only.
std::atomic<bool> g_stop{false};

void requestStop(int /*signal*/) {
  g_stop = true;
}

}  // namespace

int runShell(
    int argc, char** argv, const std::string& name, const std::string& description,
    const std::function<void(const ShellArguments&, const std::atomic<bool>& stop)>& body) {
  CLI::App app{description, name};
  ShellArguments arguments;
  app.add_option("--config", arguments.config_path, "configuration file (YAML)");
  app.add_option("--lcm-url", arguments.lcm_url,
                 "LCM provider, for instance udpm://239.255.76.67:7667?ttl=0");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error);
    return code == 0 ? 0 : 2;
  }
  std::signal(SIGINT, requestStop);
  std::signal(SIGTERM, requestStop);
  // A device that goes away while it is written to must not end the process.
  std::signal(SIGPIPE, SIG_IGN);
  try {
    body(arguments, g_stop);
  } catch (const std::exception& error) {
    std::cerr << name << ": " << error.what() << std::endl;
    return 1;
  }
  return 0;
}

}  // namespace tread
