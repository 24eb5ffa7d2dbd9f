// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/bus/lcm_address.hpp"
#include "common/pattern/pattern.hpp"

namespace tread::launch {

/// A missing prerequisite and the command that provides it.
struct HostFinding {
  bool critical = true;  ///< false: the launch may start anyway
  std::string problem;
  std::string remedy;
};

/// One line: "NAME: PROBLEM; fix: REMEDY"; "advice" precedes findings that are not critical.
std::string findingLine(const std::string& launch_name, const HostFinding& finding);
bool anyCritical(const std::vector<HostFinding>& findings);

/// A required program and its Debian package.
HostFinding missingTool(const std::string& tool, const std::string& package);

using tread::LcmAddress;
using tread::parseLcmUrl;

/// Receive buffer that holds a burst of map tiles [byte].
constexpr int64_t kWantedBuffer = 2097152;

/// Multicast settings of the host.
struct NetworkFacts {
  bool can_ask = true;       ///< the program `ip` exists
  std::string route_device;  ///< device of the route to the multicast group; empty = no route
  bool loopback_up = false;
  bool loopback_multicast = false;
  bool delivered = false;      ///< a test datagram to the group came back
  bool sealed = false;         ///< the processes have a key
  int64_t receive_buffer = 0;  ///< largest one that the kernel grants, net.core.rmem_max [byte]
};

/// Device in the output of `ip route get GROUP`; empty if there is no route.
std::string routeDevice(const std::string& answer);

/// Option with a working LCM URL.
std::string urlRemedy(bool simulated);

/// With ttl 0 messages must stay on the loopback device, where they survive an unplugged network
/// cable. If other hosts can send messages there must be a key. A simulated launch may use another
/// device or TCP (tcpq), as in a container.
std::vector<HostFinding> checkNetwork(const LcmAddress& address, const NetworkFacts& facts,
                                      bool simulated);

/// State of one process's program, configuration and device on this host.
struct ProcessFacts {
  std::string name;
  std::string program;  ///< as in the launch file
  bool program_found = false;
  std::string config;  ///< path; empty = none
  bool config_readable = true;
  int check_code = 0;         ///< exit code of the program's --check
  std::string check_line;     ///< the problem that --check printed
  std::string configuration;  ///< effective configuration, defaults included; empty if refused
  std::string device;         ///< path of a tty; empty = none
  bool device_present = true;
  bool device_usable = true;  ///< readable and writable
};

std::vector<HostFinding> checkProcess(const ProcessFacts& facts);

/// Finds patterns that the planner can never drive, because each of its plans must end at
/// standstill within the known map.
std::vector<HostFinding> checkReach(const PatternSet& patterns, double marking_range);

/// The tty that a process will open: from its last `--set address=`, else from its configuration.
/// Empty if there is none or if it is in the run folder, where another process creates it.
std::string deviceOf(const std::vector<std::string>& arguments, const std::string& config_address,
                     const std::string& run);

/// State of the run folder.
struct FolderFacts {
  std::string path;
  bool writable = false;
  int64_t free_bytes = 0;
  size_t longest_socket = 0;  ///< byte
  int owner = 0;              ///< pid of the tread-launch that runs in it; 0 = none
  bool occupied = false;      ///< a launch is running in it
  std::string foreign{};      ///< a file in it that we may not write; empty = none
  std::string owner_of_foreign{};
  std::string no_folder{};  ///< a file or dangling link in the place of the folder; empty = none
};

std::vector<HostFinding> checkFolder(const FolderFacts& facts);

}  // namespace tread::launch
