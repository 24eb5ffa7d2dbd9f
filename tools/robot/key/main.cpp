// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <iostream>
#include <string>

#include <CLI/CLI.hpp>

#include "common/config/command_line.hpp"
#include "common/seal/key_file.hpp"

namespace {

constexpr const char* kFooter =
    "A robot with a key accepts only messages that were sealed with it: nobody else on the "
    "network\n"
    "can arm or drive it, and a recorded message has no effect. Anybody can still stop it.\n"
    "Name the file as key: in the launch file, and by --key or TREAD_KEY for the commands of "
    "the\n"
    "operator. Each process reads it once, at its start.";

int run(int argc, char** argv) {
  CLI::App app{"Creates and checks the key that a robot and its operators share.", "tread-key"};
  app.footer(kFooter);
  app.require_subcommand(1);
  std::string path;
  const auto addCommand = [&](const std::string& name, const std::string& description) {
    CLI::App* command = app.add_subcommand(name, description);
    command->add_option("FILE", path, "the key's file")->required();
    return command;
  };
  const CLI::App* make = addCommand("new", "Creates a key in a new file that only you can read.");
  const CLI::App* show = addCommand("show", "Prints the key's fingerprint, never the key itself.");
  addCommand("check", "Checks whether the robot's processes would accept this file.");
  if (const auto code = tread::parseCommandLine(app, argc, argv)) return *code;
  if (make->parsed()) tread::writeNewKey(path);
  const std::string fingerprint = tread::fingerprint(tread::readKey(path));
  if (show->parsed())
    std::cout << fingerprint << std::endl;
  else
    std::cout << path << ": " << (make->parsed() ? "made" : "good") << ", fingerprint "
              << fingerprint << std::endl;
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return tread::runProgram("tread-key", [&] { return run(argc, argv); });
}
