// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/system/two_hosts.hpp"

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <random>
#include <stdexcept>

#include <fcntl.h>
#include <linux/if_tun.h>
#include <net/if.h>
#include <poll.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tread::testing {
namespace {

void must(const std::string& command) {
  if (std::system((command + " 2>/dev/null").c_str()) != 0)
    throw std::runtime_error("two hosts are not allowed here: " + command);
}

/// Without root privileges, as root of a user namespace.
bool leaveNetwork() {
  const std::string uid = std::to_string(getuid());
  const std::string gid = std::to_string(getgid());
  if (unshare(CLONE_NEWNET) == 0) return true;
  if (unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) return false;
  std::ofstream("/proc/self/setgroups") << "deny";
  std::ofstream("/proc/self/uid_map") << "0 " << uid << " 1";
  std::ofstream("/proc/self/gid_map") << "0 " << gid << " 1";
  return true;
}

/// A child in a separate network that waits to be killed.
pid_t makeStation() {
  int ready[2];
  if (pipe2(ready, O_CLOEXEC) != 0) return -1;
  const pid_t child = fork();
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    const char done = unshare(CLONE_NEWNET) == 0 ? 'y' : 'n';
    const bool told = write(ready[1], &done, 1) == 1;
    while (told) pause();
    _exit(1);
  }
  char answer = 'n';
  const bool heard = read(ready[0], &answer, 1) == 1;
  close(ready[0]);
  close(ready[1]);
  if (heard && answer == 'y') return child;
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  return -1;
}

/// A network device whose frames pass through the descriptor; -1 on failure.
int openDevice(const char* name) {
  const int device = open("/dev/net/tun", O_RDWR | O_NONBLOCK | O_CLOEXEC);
  ifreq request{};
  request.ifr_flags = IFF_TAP | IFF_NO_PI;
  std::snprintf(request.ifr_name, sizeof request.ifr_name, "%s", name);
  if (device >= 0 && ioctl(device, TUNSETIFF, &request) == 0) return device;
  if (device >= 0) close(device);
  return -1;
}

}  // namespace

BadCable::BadCable(int robot, int station, const CableFaults& faults)
    : ends_{robot, station}, faults_(faults), thread_([this] { carry(); }) {}

BadCable::~BadCable() {
  stop_ = true;
  thread_.join();
  for (const int end : ends_) close(end);
}

void BadCable::carry() {
  using Clock = std::chrono::steady_clock;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  /// By arrival time: the receiving end and the bytes.
  std::multimap<Clock::time_point, std::pair<int, std::vector<char>>> frames;
  while (!stop_) {
    pollfd polled[2] = {{ends_[0], POLLIN, 0}, {ends_[1], POLLIN, 0}};
    poll(polled, 2, 1);
    for (int end = 0; end < 2; ++end) {
      std::vector<char> frame(2048);
      while ((polled[end].revents & POLLIN) != 0) {
        const ssize_t size = read(ends_[end], frame.data(), frame.size());
        if (size <= 0) break;
        if (!plugged_ || share(random) < faults_.loss) continue;
        const std::chrono::duration<double> late(faults_.delay + faults_.jitter * share(random));
        frames.emplace(Clock::now() + std::chrono::duration_cast<Clock::duration>(late),
                       std::pair(1 - end, std::vector<char>(frame.begin(), frame.begin() + size)));
      }
    }
    for (auto due = frames.begin(); due != frames.end() && due->first <= Clock::now();
         due = frames.erase(due)) {
      const auto& [end, bytes] = due->second;
      // A device that is down accepts nothing, like a cut cable.
      if (write(ends_[end], bytes.data(), bytes.size()) < 0) continue;
    }
  }
}

TwoHosts::TwoHosts(const CableFaults& faults)
    : url_("udpm://239.255.76.67:" + std::to_string(20000 + getpid() % 20000) +
           "?ttl=1&recv_buf_size=2097152") {
  if (!leaveNetwork()) throw std::runtime_error("two hosts are not allowed here");
  station_ = makeStation();
  if (station_ < 0) throw std::runtime_error("two hosts are not allowed here");
  try {
    joinHosts(faults);
  } catch (...) {
    kill(station_, SIGKILL);
    waitpid(station_, nullptr, 0);
    throw;
  }
}

TwoHosts::~TwoHosts() {
  bad_cable_.reset();
  kill(station_, SIGKILL);
  waitpid(station_, nullptr, 0);
}

/// Result of `make`, executed in the station's network.
template <class Make>
int TwoHosts::there(const Make& make) const {
  const int here = open("/proc/self/ns/net", O_RDONLY | O_CLOEXEC);
  const int station = open(network().c_str(), O_RDONLY | O_CLOEXEC);
  int made = -1;
  if (setns(station, CLONE_NEWNET) == 0) made = make();
  const bool back = setns(here, CLONE_NEWNET) == 0;
  close(here);
  close(station);
  if (!back || made < 0) throw std::runtime_error("the station's network cannot be used");
  return made;
}

void TwoHosts::joinHosts(const CableFaults& faults) {
  const std::string at_station = "nsenter --net=" + network() + " ";
  if (faults.delay + faults.jitter + faults.loss > 0.0) {
    const int robot = openDevice("robot");
    if (robot < 0) throw std::runtime_error("two hosts are not allowed here: /dev/net/tun");
    bad_cable_ =
        std::make_unique<BadCable>(robot, there([] { return openDevice("station"); }), faults);
  } else {
    must("ip link add robot type veth peer name station netns " + std::to_string(station_));
  }
  must("ip link set lo up && ip link set robot up");
  must("ip addr add " + std::string(kRobot) + "/24 dev robot");
  must("ip route add 224.0.0.0/4 dev robot");
  must(at_station + "ip link set lo up && " + at_station + "ip link set station up");
  must(at_station + "ip addr add " + std::string(kStation) + "/24 dev station");
  must(at_station + "ip route add 224.0.0.0/4 dev station");
}

std::vector<std::string> TwoHosts::atStation() const {
  return {"/usr/bin/nsenter", "--net=" + network()};
}

void TwoHosts::plug(bool in) {
  if (bad_cable_) return bad_cable_->plug(in);
  // Routes disappear and return with the station's end. The robot's end stays up.
  const std::string at_station = "nsenter --net=" + network() + " ";
  must(at_station + "ip link set station " + (in ? "up" : "down"));
  if (in) must(at_station + "ip route add 224.0.0.0/4 dev station");
}

int TwoHosts::stationSocket() const {
  return there([] { return socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0); });
}

}  // namespace tread::testing
