// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include <sys/prctl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>

#include "tools/launch/host.hpp"
#include "tools/launch/log_rotation.hpp"
#include "tools/launch/run_command.hpp"

namespace {

constexpr const char* kNoLogger = "there is no lcm-logger (apt-get install liblcm-bin)";

struct Options {
  std::string file;
  std::string lcm_url;
  int keep = 20;
  int split_mb = 200;
  bool check = false;
  bool with_parent = false;
};

void declare(CLI::App& app, Options& options) {
  app.add_option("FILE", options.file, "log; FILE.0 is the newest, FILE.1 the one before")
      ->required();
  app.add_option("--lcm-url", options.lcm_url, "LCM provider");
  app.add_option("--keep", options.keep, "files that are kept")->check(CLI::Range(1, 10000));
  app.add_option("--split-mb", options.split_mb, "size of a file [MB]")
      ->check(CLI::Range(1, 100000));
  app.add_flag("--check", options.check, "only read the command line");
  app.add_flag("--with-parent", options.with_parent, "end when the starting process is gone");
}

[[noreturn]] void becomeLogger(const Options& options) {
  std::vector<std::string> words{"lcm-logger", "--quiet",
                                 "--rotate=" + std::to_string(options.keep),
                                 "--split-mb=" + std::to_string(options.split_mb)};
  // 1.3.1 knows no -l, though its help says so.
  if (!options.lcm_url.empty()) words.push_back("--lcm-url=" + options.lcm_url);
  words.push_back(options.file);
  tread::launch::becomeProgram(words);
  throw std::runtime_error(kNoLogger);
}

int run(int argc, char** argv) {
  const pid_t parent = getppid();
  CLI::App app{"Records all messages with lcm-logger, rotated; no earlier log is overwritten.",
               "tread-logger"};
  Options options;
  declare(app, options);
  CLI11_PARSE(app, argc, argv);
  if (options.check) {
    if (tread::launch::findProgram("lcm-logger", "").empty()) throw std::runtime_error(kNoLogger);
    return 0;
  }
  if (options.with_parent) {
    prctl(PR_SET_PDEATHSIG, SIGINT);  // stays in force for what we become
    if (getppid() != parent) return 0;
  }
  const auto folder = std::filesystem::path(options.file).parent_path();
  if (!folder.empty()) std::filesystem::create_directories(folder);
  tread::launch::makeRoomForLog(options.file, options.keep);
  becomeLogger(options);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tread-logger: %s\n", error.what());
    return 1;
  }
}
