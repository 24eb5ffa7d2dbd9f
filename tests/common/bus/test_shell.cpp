// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The common main function of all processes, tested from outside with tread-mapping.
#include <catch2/catch.hpp>

#include <poll.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>

#include "common/bus/lcm_bus.hpp"
#include "tests/system/process.hpp"

using namespace tread;
using namespace tread::testing;

namespace {

constexpr const char* kMapping = "tread-mapping";
/// Arguments: a process needs its robot.
const std::string kRobot = TREAD_SOURCE_DIR "/config/robots/teodor/";

/// Output and exit status of a short run.
struct Ending {
  int code = -1;
  std::string output;
  long lines() const { return std::count(output.begin(), output.end(), '\n'); }
};

Ending run(const std::vector<std::string>& arguments, const std::string& program = kMapping) {
  const std::string file = "shell_" + std::to_string(getpid()) + ".txt";
  Ending ending;
  {
    Process process(program, arguments, file);
    REQUIRE(process.waitFor(10));
    ending.code = process.exitCode();
  }
  std::ifstream output(file);
  ending.output.assign(std::istreambuf_iterator<char>(output), {});
  std::remove(file.c_str());
  return ending;
}

/// Waits until a process on this bus publishes HEALTH; false after 10 s.
bool heardOf(LcmBus& bus) {
  bool heard = false;
  bus.subscribe<health_t>(kHealth, [&heard](const health_t&) { heard = true; });
  for (int i = 0; i < 500 && !heard; ++i) bus.handle(20);
  return heard;
}

/// The test's end of a bus; null if LCM has no network.
std::unique_ptr<LcmBus> listenTo(const std::string& url) {
  try {
    return std::make_unique<LcmBus>(url, TimeSource::kHost);
  } catch (const std::runtime_error& error) {
    WARN("skipped: " << error.what());
    return nullptr;
  }
}

/// An intermediate parent that starts the program and then idles; both hold the pipe's end, which
/// closes when both have ended.
class Family {
 public:
  Family(const std::string& url, bool with_parent) {
    REQUIRE(pipe(ends_) == 0);
    parent_ = fork();
    if (parent_ != 0) {
      close(ends_[1]);
      REQUIRE(read(ends_[0], &child_, sizeof child_) == sizeof child_);
      return;
    }
    const std::string path = std::string(TREAD_BIN_DIR) + "/" + kMapping;
    const std::string config = kRobot + "mapping.yaml";
    const pid_t child = fork();
    if (child == 0) {
      execl(path.c_str(), path.c_str(), "--config", config.c_str(), "--lcm-url", url.c_str(),
            with_parent ? "--with-parent" : nullptr, nullptr);
      _exit(127);
    }
    if (write(ends_[1], &child, sizeof child) != sizeof child) _exit(1);
    for (;;) pause();
  }
  ~Family() {
    killParent();
    if (!gone(0)) kill(child_, SIGKILL);
    close(ends_[0]);
  }
  Family(const Family&) = delete;
  Family& operator=(const Family&) = delete;

  void killParent() {
    if (parent_ > 0) {
      kill(parent_, SIGKILL);
      waitpid(parent_, nullptr, 0);
    }
    parent_ = -1;
  }
  /// Waits until parent and program have ended.
  bool gone(int milliseconds) const {
    pollfd end{ends_[0], POLLIN, 0};
    return poll(&end, 1, milliseconds) > 0;
  }

 private:
  int ends_[2] = {-1, -1};
  pid_t parent_ = -1;
  pid_t child_ = -1;
};

}  // namespace

TEST_CASE("SIGINT, SIGTERM and a closed terminal end a process in order, with code 0") {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const std::string url = ownLcmUrl();
    const auto bus = listenTo(url);
    if (!bus) return;
    Process process(kMapping, {"--config", kRobot + "mapping.yaml", "--lcm-url", url});
    REQUIRE(heardOf(*bus));
    process.signal(signal);
    CAPTURE(signal);
    REQUIRE(process.waitFor(5));
    CHECK(process.exitCode() == 0);
  }
}

TEST_CASE("what nohup started outlives its terminal") {
  const std::string url = ownLcmUrl();
  const auto bus = listenTo(url);
  if (!bus) return;
  const auto before = std::signal(SIGHUP, SIG_IGN);  // the program inherits it
  Process process(kMapping, {"--config", kRobot + "mapping.yaml", "--lcm-url", url});
  std::signal(SIGHUP, before);
  REQUIRE(heardOf(*bus));
  process.signal(SIGHUP);
  CHECK_FALSE(process.waitFor(0.5));
  process.signal(SIGTERM);
  CHECK(process.waitFor(5));
}

TEST_CASE("with --with-parent a process ends when its parent is killed, and only then") {
  for (const bool with_parent : {true, false}) {
    const std::string url = ownLcmUrl();
    const auto bus = listenTo(url);
    if (!bus) return;
    Family family(url, with_parent);
    REQUIRE(heardOf(*bus));
    CHECK_FALSE(family.gone(0));
    family.killParent();
    CHECK(family.gone(with_parent ? 5000 : 500) == with_parent);
  }
}

TEST_CASE(
    "checking (--check) prints the configuration that holds, with code 0, or one line with code "
    "1") {
  const std::string file = "shell_" + std::to_string(getpid()) + ".yaml";
  std::ofstream(file) << "silence: 2\nrobot: " << kRobot << "robot.yaml\n";
  const Ending good = run({"--config", file, "--check"});
  CHECK(good.code == 0);
  CHECK(good.output.find("silence: 2") != std::string::npos);
  CHECK(good.output.find("max_wait: ") != std::string::npos);  // a default
  std::ofstream(file) << "silenc: 2\nrobot: " << kRobot << "robot.yaml\n";
  const Ending mistyped = run({"--config", file, "--check"});
  std::remove(file.c_str());
  CHECK(mistyped.code == 1);
  CHECK(mistyped.lines() == 1);
  CHECK(mistyped.output.find("tread-mapping: " + file + ":1: ") == 0);
  const Ending absent = run({"--config", file, "--check"});
  CHECK(absent.code == 1);
  CHECK(absent.lines() == 1);
  CHECK(absent.output.find(file) != std::string::npos);
}

TEST_CASE("a process that may open too few files says so in one line, and does not hang") {
  for (const int most : {9, 20}) {
    const Ending ending = run({"--nofile=" + std::to_string(most) + ":" + std::to_string(most),
                               std::string(TREAD_BIN_DIR) + "/" + kMapping, "--config",
                               kRobot + "mapping.yaml", "--lcm-url", ownLcmUrl()},
                              "/usr/bin/prlimit");
    INFO(ending.output);
    CHECK(ending.code == 1);
    CHECK(ending.lines() == 1);
    CHECK(ending.output.find("more files, 24 are needed: ulimit -n 1024") != std::string::npos);
  }
}

TEST_CASE("a mistake in --set is one line that names it") {
  for (const char* words : {"silence=loud", "silence=-1", "silenc=2", "silence", "=2",
                            "silence=", "a.b.c=1", "silence=[1", "silence=1\nsilence: 2"}) {
    const Ending ending = run({"--config", kRobot + "mapping.yaml", "--check", "--set", words});
    CAPTURE(words, ending.output);
    CHECK(ending.code == 1);
    CHECK(ending.lines() == 1);
    CHECK(ending.output.find("tread-mapping: ") == 0);
    CHECK(ending.output.find("--set") != std::string::npos);
  }
  CHECK(run({"--config", kRobot + "mapping.yaml", "--check", "--set", "silence=2", "--set",
             "max_wait=1"})
            .code == 0);
}

TEST_CASE("a wrong command line ends with code 2") {
  CHECK(run({"--chek"}).code == 2);
  CHECK(run({"--set"}).code == 2);
  CHECK(run({"--help"}).code == 0);
}
