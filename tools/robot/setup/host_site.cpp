// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/setup/host_site.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>
#include <thread>

#include <sys/wait.h>
#include <unistd.h>

#include "common/bus/host_clock.hpp"
#include "common/bus/lcm_bus.hpp"
#include "common/link/make_link.hpp"
#include "common/seal/key_file.hpp"
#include "tools/robot/launch/host.hpp"
#include "tools/robot/launch/launch_file.hpp"

namespace tread::setup {
namespace {

namespace fs = std::filesystem;

constexpr int64_t kLaunchPatience = 10'000'000;  // [us]
constexpr int64_t kSlice = 2'000;                // [us] waited at a time
constexpr int kCanHardware = 280;                // ARPHRD_CAN
constexpr const char* kSickPort = ":2111";
constexpr const char* kVelodyne = "udp:2368";

std::vector<std::string> entriesOf(const fs::path& folder) {
  std::vector<std::string> paths;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none))
    paths.push_back(entry.path().string());
  std::sort(paths.begin(), paths.end());
  return paths;
}

/// Serial devices, by names that survive replugging if they have one.
std::vector<std::string> serialLines() {
  std::vector<std::string> ports;
  std::set<std::string> named;
  for (const std::string& path : entriesOf("/dev/serial/by-id")) {
    std::error_code none;
    named.insert(fs::canonical(path, none).string());
    ports.push_back("tty:" + path);
  }
  for (const std::string& path : entriesOf("/dev"))
    for (const char* kind : {"/dev/ttyUSB", "/dev/ttyACM"})
      if (path.rfind(kind, 0) == 0 && named.count(path) == 0) ports.push_back("tty:" + path);
  return ports;
}

std::vector<std::string> canInterfaces() {
  std::vector<std::string> ports;
  for (const std::string& path : entriesOf("/sys/class/net")) {
    std::ifstream file(path + "/type");
    int hardware = 0;
    if (file >> hardware && hardware == kCanHardware)
      ports.push_back("can:" + fs::path(path).filename().string());
  }
  return ports;
}

/// Hosts that this one has communicated with recently.
std::vector<std::string> neighbours() {
  std::vector<std::string> hosts;
  std::ifstream table("/proc/net/arp");
  std::string line;
  std::getline(table, line);
  while (std::getline(table, line)) {
    std::istringstream words(line);
    std::string host;
    if (words >> host) hosts.push_back(host);
  }
  return hosts;
}

/// tread-launch with the processes that it started, and a bus.
class LaunchedRobot : public RobotSession {
 public:
  LaunchedRobot(const std::string& file, const std::string& folder, const HostOptions& options,
                const std::atomic<bool>& interrupted)
      : interrupted_(interrupted), run_(options.run) {
    launch::LaunchSettings settings;
    settings.file = file;
    settings.run = options.run;
    settings.bin = launch::ownFolder();
    settings.lcm_url = options.lcm_url;
    settings.values["robot"] = folder;
    ConfigReader reader = ConfigReader::fromFile(file);
    launch::LaunchFile launched = launch::readLaunchFile(reader, settings);
    launch::takeNamedKey(launched);
    pid_ = fork();
    if (pid_ < 0) throw std::runtime_error("tread-launch cannot be started");
    if (pid_ == 0) {
      setpgid(0, 0);  // Ctrl-C is handled by the setup, which then stops this in order
      launch::becomeProgram({settings.bin + "/tread-launch", file, "--set", "robot=" + folder,
                             "--run", options.run, "--lcm-url", launched.lcm_url});
      _exit(127);
    }
    openBus(launched);
  }
  ~LaunchedRobot() override { end(); }

  Bus& bus() override { return *bus_; }
  void pass(int64_t duration) override {
    for (const int64_t end = hostNow() + duration; hostNow() < end;) {
      if (interrupted_) throw std::runtime_error("interrupted, the robot was stopped");
      if (waitpid(pid_, nullptr, WNOHANG) != 0)
        throw std::runtime_error("tread-launch has ended; look at " + run_ + "/log");
      bus_->handle(static_cast<int>(std::max<int64_t>(1, (end - hostNow()) / 1000)));
    }
  }

 private:
  /// Some LCM providers are available only once tread-launch runs.
  void openBus(const launch::LaunchFile& launched) {
    for (const int64_t patient = hostNow() + kLaunchPatience; bus_ == nullptr;) {
      try {
        // The robot's clock is this host's. A clock that follows the messages would jump at the
        // first ones, and a pending request would time out.
        bus_ = std::make_unique<LcmBus>(BusAccess{launched.lcm_url, hostSealer(launched.key)},
                                        TimeSource::kHost);
      } catch (const std::runtime_error&) {
        if (hostNow() > patient || interrupted_) {
          end();
          throw;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
      }
    }
  }
  void end() const {
    kill(pid_, SIGINT);
    waitpid(pid_, nullptr, 0);
  }

  const std::atomic<bool>& interrupted_;
  std::string run_;
  pid_t pid_ = -1;
  std::unique_ptr<LcmBus> bus_;
};

}  // namespace

std::vector<std::string> portsOfHost() {
  std::vector<std::string> ports = serialLines();
  for (const std::string& port : canInterfaces()) ports.push_back(port);
  ports.emplace_back(kVelodyne);
  for (const std::string& host : neighbours()) ports.push_back("tcp:" + host + kSickPort);
  return ports;
}

HostSite::HostSite(HostOptions options, const std::atomic<bool>& interrupted)
    : options_(std::move(options)), interrupted_(interrupted) {
  ports_ = options_.ports.empty() ? portsOfHost() : options_.ports;
  for (const std::string& port : ports_) parseLinkAddress(port);  // throws if it is invalid
}

std::unique_ptr<Link> HostSite::open(const std::string& address) {
  auto link = makeLink(address);
  requireFree(*link);
  return link;
}

int64_t HostSite::now() {
  return hostNow();
}

void HostSite::pass(int64_t duration) {
  for (const int64_t end = hostNow() + duration; hostNow() < end;) {
    if (interrupted_) throw std::runtime_error("interrupted, the motors were stopped");
    std::this_thread::sleep_for(std::chrono::microseconds(std::min(kSlice, end - hostNow() + 1)));
  }
}

std::unique_ptr<RobotSession> HostSite::start(const std::string& folder, Processes which) {
  const char* file = which == Processes::kAll ? "/robot.yaml" : "/recording.yaml";
  return std::make_unique<LaunchedRobot>(options_.launch_folder + file,
                                         fs::absolute(folder).lexically_normal().string(), options_,
                                         interrupted_);
}

}  // namespace tread::setup
