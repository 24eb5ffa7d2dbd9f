// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// lcm-spy as started by tread-spy, on a virtual display, with a publisher on its own bus.
#include <catch2/catch.hpp>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "common/bus/lcm_bus.hpp"
#include "common/seal/key_file.hpp"
#include "tests/system/process.hpp"

using namespace tread;
using namespace tread::testing;

namespace {

std::string contentOf(const std::string& file) {
  std::ifstream in(file);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

/// A temporary folder for outputs.
class Folder {
 public:
  Folder()
      : path_(std::filesystem::temp_directory_path() / ("tread_spy_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

/// An in-memory display, named by DISPLAY while this object lives.
class Display {
 public:
  explicit Display(const Folder& folder)
      : process_(TREAD_XVFB, {"-displayfd", "1", "-screen", "0", "1024x768x24", "-nolisten", "tcp"},
                 folder.file("display")) {
    std::string number;
    for (int i = 0; i < 200 && number.empty(); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      number = displayIn(contentOf(folder.file("display")));
    }
    REQUIRE_FALSE(number.empty());
    setenv("DISPLAY", (":" + number).c_str(), 1);
  }
  ~Display() { unsetenv("DISPLAY"); }

 private:
  /// The line with a number: next to another display it first complains about those in use.
  static std::string displayIn(const std::string& said) {
    std::istringstream lines(said);
    std::string line;
    while (std::getline(lines, line))
      if (!line.empty() && line.find_first_not_of("0123456789") == std::string::npos) return line;
    return "";
  }

  Process process_;
};

/// INS at 50 Hz.
class Publisher {
 public:
  explicit Publisher(const std::string& url, const std::string& key = "")
      : bus_(BusAccess{url, hostSealer(key)}, TimeSource::kHost) {
    thread_ = std::thread([this] {
      ins_t ins{};
      while (!stop_) {
        ins.utime = bus_.now();
        ++ins.seq;
        bus_.publish(kIns, ins);
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
      }
    });
  }
  ~Publisher() {
    stop_ = true;
    thread_.join();
  }
  Publisher(const Publisher&) = delete;
  Publisher& operator=(const Publisher&) = delete;

 private:
  LcmBus bus_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// Whether lcm-spy can run here; else prints the reason in one line.
bool possible() {
  const bool tools = std::filesystem::exists(TREAD_XVFB) && std::filesystem::exists(TREAD_JAVA);
  const bool jar =
      std::filesystem::exists(std::string(TREAD_BIN_DIR) + "/../share/java/tread-lcmtypes.jar");
  if (!tools || !jar) WARN("skipped: no Xvfb, Java or jar of our types; tools/setup installs them");
  if (!tools || !jar) return false;
  try {
    const LcmBus bus(ownLcmUrl(), TimeSource::kHost);
    return true;
  } catch (const std::runtime_error& error) {
    WARN("skipped: " << error.what());
    return false;
  }
}

std::string classPath(const Folder& folder) {
  Process process("tread-spy", {"--class-path"}, folder.file("path"));
  REQUIRE(process.waitFor(10));
  REQUIRE(process.exitCode() == 0);
  std::string path;
  std::istringstream(contentOf(folder.file("path"))) >> path;
  return path;
}

}  // namespace

TEST_CASE(
    "lcm-spy shows INS decoded, with its rate, from the class path of tread-spy, sealed or not") {
  if (!possible()) return;
  const Folder folder;
  const Display display(folder);
  const std::string url = ownLcmUrl();
  writeNewKey(folder.file("key"));
  const Publisher publisher(url, GENERATE(false, true) ? folder.file("key") : "");
  Process spy(TREAD_JAVA,
              {"-Djava.net.preferIPv4Stack=true", "-cp", classPath(folder),
               TREAD_SOURCE_DIR "/tests/tools/robot/spy/SpySees.java", url, "INS", "ins_t", "40"},
              folder.file("spy"));
  REQUIRE(spy.waitFor(60));
  INFO(contentOf(folder.file("spy")));
  REQUIRE(spy.exitCode() == 0);
}

TEST_CASE("tread-spy starts, finds our types and ends when it is told to") {
  if (!possible()) return;
  const Folder folder;
  const Display display(folder);
  Process spy("tread-spy", {"--lcm-url", ownLcmUrl()}, folder.file("spy"));
  std::string said;
  for (int i = 0; i < 400 && said.find("LCM types") == std::string::npos; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    said = contentOf(folder.file("spy"));
  }
  INFO(said);
  REQUIRE(said.find("tread-lcmtypes.jar") != std::string::npos);
  REQUIRE(said.find("Found ") != std::string::npos);
  // The types of the channels and those nested in them.
  int types = 0;
  REQUIRE(std::sscanf(said.c_str() + said.find("Found "), "Found %d LCM types", &types) == 1);
  REQUIRE(types >= static_cast<int>(kChannels.size()));
  REQUIRE(said.find("Unrecognized option") == std::string::npos);
  REQUIRE(spy.running());
  spy.signal(SIGTERM);
  REQUIRE(spy.waitFor(10));
}

TEST_CASE("tread-spy without a display says so in one line") {
  if (!possible()) return;
  const Folder folder;
  unsetenv("DISPLAY");
  Process spy("tread-spy", {}, folder.file("spy"));
  REQUIRE(spy.waitFor(10));
  REQUIRE(spy.exitCode() == 1);
  const std::string said = contentOf(folder.file("spy"));
  REQUIRE(said.find("there is no display") != std::string::npos);
  REQUIRE(said.find('\n') == said.size() - 1);
}

TEST_CASE("tread-spy whose types are not built says so in one line and starts no spy") {
  const Folder folder;
  std::filesystem::create_directories(folder.file("bin"));
  std::filesystem::copy(TREAD_SOURCE_DIR "/tools/robot/tread-spy", folder.file("bin"));
  setenv("DISPLAY", ":0", 1);
  Process spy(folder.file("bin/tread-spy"), {}, folder.file("spy"));
  unsetenv("DISPLAY");
  REQUIRE(spy.waitFor(10));
  REQUIRE(spy.exitCode() == 1);
  const std::string said = contentOf(folder.file("spy"));
  REQUIRE(said.find("tread-lcmtypes.jar is not built") != std::string::npos);
  REQUIRE(said.find('\n') == said.size() - 1);
}
