// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/system/two_hosts.hpp"

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include <fcntl.h>
#include <sched.h>
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

/// Without root, as root of a user namespace of one's own.
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

/// A child in a network of its own that waits to be killed.
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

}  // namespace

TwoHosts::TwoHosts()
    : url_("udpm://239.255.76.67:" + std::to_string(20000 + getpid() % 20000) +
           "?ttl=1&recv_buf_size=2097152") {
  if (!leaveNetwork()) throw std::runtime_error("two hosts are not allowed here");
  station_ = makeStation();
  if (station_ < 0) throw std::runtime_error("two hosts are not allowed here");
  try {
    joinHosts();
  } catch (...) {
    kill(station_, SIGKILL);
    waitpid(station_, nullptr, 0);
    throw;
  }
}

TwoHosts::~TwoHosts() {
  kill(station_, SIGKILL);
  waitpid(station_, nullptr, 0);
}

void TwoHosts::joinHosts() const {
  const std::string there = "nsenter --net=" + network() + " ";
  must("ip link add robot type veth peer name station netns " + std::to_string(station_));
  must("ip link set lo up && ip link set robot up");
  must("ip addr add " + std::string(kRobot) + "/24 dev robot");
  must("ip route add 224.0.0.0/4 dev robot");
  must(there + "ip link set lo up && " + there + "ip link set station up");
  must(there + "ip addr add " + std::string(kStation) + "/24 dev station");
  must(there + "ip route add 224.0.0.0/4 dev station");
}

std::vector<std::string> TwoHosts::atStation() const {
  return {"/usr/bin/nsenter", "--net=" + network()};
}

void TwoHosts::plug(bool in) const {
  // Routes go with the station's end, and come back with it. The robot's end stays up.
  const std::string there = "nsenter --net=" + network() + " ";
  must(there + "ip link set station " + (in ? "up" : "down"));
  if (in) must(there + "ip route add 224.0.0.0/4 dev station");
}

int TwoHosts::stationSocket() const {
  const int here = open("/proc/self/ns/net", O_RDONLY | O_CLOEXEC);
  const int there = open(network().c_str(), O_RDONLY | O_CLOEXEC);
  int made = -1;
  if (setns(there, CLONE_NEWNET) == 0) made = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const bool back = setns(here, CLONE_NEWNET) == 0;
  close(here);
  close(there);
  if (!back || made < 0) throw std::runtime_error("no socket at the station");
  return made;
}

}  // namespace tread::testing
