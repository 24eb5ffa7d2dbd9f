// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <iostream>
#include <string>

#include <CLI/CLI.hpp>

#include "common/config/command_line.hpp"
#include "common/seal/key_file.hpp"

namespace {

constexpr const char* kFooter =
    "With a key a robot takes only messages that were sealed with it: nobody else on the network\n"
    "arms it or drives it, and a recorded message does nothing. Stopping stays open to everybody.\n"
    "Name the file as key: in the launch file, and with --key or TREAD_KEY for the commands of "
    "the\n"
    "operator. It is read once, at the start of each process.";

int run(int argc, char** argv) {
  CLI::App app{"Makes and checks the key that a robot and its operators share.", "tread-key"};
  app.footer(kFooter);
  app.require_subcommand(1);
  std::string path;
  const auto addCommand = [&](const std::string& name, const std::string& description) {
    CLI::App* command = app.add_subcommand(name, description);
    command->add_option("FILE", path, "the key's file")->required();
    return command;
  };
  const CLI::App* make = addCommand("new", "Makes a new key in a new file that only you can read.");
  const CLI::App* show = addCommand("show", "Prints the key's fingerprint, never the key itself.");
  addCommand("check", "Says whether the robot's processes would take this file.");
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
