// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <filesystem>
#include <iostream>

#include <CLI/CLI.hpp>

#include "common/bus/shell.hpp"
#include "common/config/command_line.hpp"
#include "common/config/config_folder.hpp"
#include "tools/robot/launch/host.hpp"
#include "tools/robot/setup/host_site.hpp"
#include "tools/robot/setup/setup.hpp"

namespace {

using namespace tread;
using namespace tread::setup;

struct SetupOptions {
  std::string answers;
  std::string robots = "config/robots";
  std::string pre_drive;
  HostOptions host;
};

constexpr const char* kFooter =
    "Finds the devices on this host's ports, turns each track on a stand, drives a minute in a "
    "free\n"
    "circle of 5 m radius, drives patterns there, writes ROBOTS/NAME and drives to a goal 10 m "
    "ahead. It\n"
    "asks only what no instrument can measure, and before each motion. "
    "ROBOTS/NAME/setup.html\n"
    "is the report. Keep the emergency stop at hand: before the last step nothing detects "
    "obstacles.\n"
    "Ctrl-C stops the motors. tools/robot/setup/README.md is the manual.";

int setUpHere(const SetupOptions& options, Site& site) {
  std::unique_ptr<Interview> person;
  if (options.answers.empty())
    person = std::make_unique<Terminal>(std::cin, std::cout);
  else
    person = std::make_unique<AnswersFile>(
        ConfigReader::fromFile(options.answers),
        [](const std::string& line) { std::cout << line << std::endl; });
  const SetupResult result = setUp(site, *person, options.robots);
  if (!result.folder.empty()) std::cout << "report: " << result.folder << "/setup.html\n";
  if (result.problem.empty()) return 0;
  std::cerr << "tread-setup-robot: " << result.problem << '\n';
  return 1;
}

int preDriveHere(const std::string& folder, Site& site) {
  std::cout << "The robot moves back and forth for about 10 s, less than a metre." << std::endl;
  const PreDrive drive = preDriveOf(site, folder);
  for (const commissioning::WiringFault& fault : drive.faults)
    std::cout << "WRONG: " << fault.words << '\n';
  if (!drive.problem.empty()) std::cerr << "tread-setup-robot: " << drive.problem << '\n';
  if (!drive.problem.empty() || !drive.faults.empty()) return 1;
  std::cout << "sides, directions and INS are right\n";
  return 0;
}

int run(SetupOptions options) {
  namespace fs = std::filesystem;
  std::string& launch = options.host.launch_folder;
  if (launch.empty()) launch = shippedConfig() + "/launch";
  launch = fs::canonical(launch).string();
  if (options.host.run.empty()) options.host.run = launch::defaultRunFolder("setup");
  options.host.run = fs::absolute(options.host.run).lexically_normal().string();
  HostSite site(options.host, stopRequest(0));
  return options.pre_drive.empty() ? setUpHere(options, site)
                                   : preDriveHere(options.pre_drive, site);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Sets up a robot, from its ports to its first goal.", "tread-setup-robot"};
  app.footer(kFooter);
  SetupOptions options;
  auto* answers =
      app.add_option("--answers", options.answers, "file of answers (YAML): nothing is asked")
          ->check(CLI::ExistingFile);
  app.add_option("--robots", options.robots, "folder in which NAME is created")
      ->capture_default_str();
  auto* pre_drive =
      app.add_option(
             "--pre-drive", options.pre_drive,
             "folder of a robot: drives for 10 s and reports what is swapped, reversed, dead "
             "or turned")
          ->check(CLI::ExistingDirectory);
  answers->excludes(pre_drive);
  app.add_option("--port", options.host.ports,
                 "look only at this address (repeatable); default: all ports of the host")
      ->expected(1)
      ->take_all();
  app.add_option("--run", options.host.run,
                 "folder for states and logs; default ~/.local/state/tread/setup");
  app.add_option("--launch", options.host.launch_folder,
                 "folder of robot.yaml and recording.yaml, which start the processes and name the "
                 "key; default config/launch")
      ->check(CLI::ExistingDirectory);
  app.add_option("--lcm-url", options.host.lcm_url, "LCM provider, instead of the launch files'");
  if (const auto code = parseCommandLine(app, argc, argv)) return *code;
  return runProgram("tread-setup-robot", [&] { return run(options); });
}
