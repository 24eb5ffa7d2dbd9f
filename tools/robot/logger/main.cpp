// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <atomic>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>

#include <unistd.h>

#include <CLI/CLI.hpp>

#include "common/bus/shell.hpp"
#include "common/config/command_line.hpp"
#include "common/config/problem_words.hpp"
#include "tools/robot/logger/recorder.hpp"

namespace {

struct Options {
  std::string file;
  std::string lcm_url;
  std::string key;
  int keep = 20;
  int split_mb = 200;
  int quota_mb = 0;
  bool check = false;
  bool with_parent = false;
};

void declare(CLI::App& app, Options& options) {
  app.add_option("FILE", options.file, "log; FILE.0 is the newest, FILE.1 the one before")
      ->required();
  app.add_option("--lcm-url", options.lcm_url, "LCM provider");
  app.add_option("--key", options.key,
                 "accepted but not used: sealed messages are recorded sealed");
  app.add_option("--keep", options.keep, "number of files to keep")->check(CLI::Range(1, 10000));
  app.add_option("--split-mb", options.split_mb, "size of a file [MB]")
      ->check(CLI::Range(1, 100000));
  app.add_option("--quota-mb", options.quota_mb,
                 "size of all files together [MB]: the oldest are removed; 0 = no limit")
      ->check(CLI::Range(0, 100'000'000));
  app.add_flag("--check", options.check, "only read the command line");
  app.add_flag("--with-parent", options.with_parent, "end when the starting process is gone");
}

int run(int argc, char** argv) {
  const pid_t parent = getppid();
  CLI::App app{"Records all messages as LCM event logs, rotated; no earlier log is overwritten.",
               "tread-logger"};
  Options options;
  declare(app, options);
  if (const auto code = tread::parseCommandLine(app, argc, argv)) return *code;
  if (options.check) return 0;
  const std::atomic<bool>& stop = tread::stopRequest(options.with_parent ? parent : 0);
  const auto folder = std::filesystem::path(options.file).parent_path();
  if (!folder.empty() && std::filesystem::create_directories(folder))
    std::printf("tread-logger: made the folder %s\n", folder.c_str());
  tread::logger::RecorderSettings settings;
  settings.file = options.file;
  settings.lcm_url = options.lcm_url;
  settings.keep = options.keep;
  settings.split = 1'000'000LL * options.split_mb;
  settings.quota = 1'000'000LL * options.quota_mb;
  tread::logger::Recorder recorder(settings);
  recorder.run(stop);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tread-logger: %s\n", tread::wordsOf(error).c_str());
    return 1;
  }
}
