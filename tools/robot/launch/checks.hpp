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

/// Something that is missing, and the command that mends it.
struct HostFinding {
  bool critical = true;  ///< false: starting makes sense all the same
  std::string problem;
  std::string remedy;
};

/// "NAME: PROBLEM; fix: REMEDY", and "advice" before what is not critical. One line.
std::string findingLine(const std::string& launch_name, const HostFinding& finding);
bool anyCritical(const std::vector<HostFinding>& findings);

/// A program that the host must have, and its Debian package.
HostFinding missingTool(const std::string& tool, const std::string& package);

using tread::LcmAddress;
using tread::parseLcmUrl;

/// A burst of map tiles fits into such a receive buffer [byte].
constexpr int64_t kWantedBuffer = 2097152;

/// What the host says about multicast.
struct NetworkFacts {
  bool can_ask = true;       ///< there is the program ip
  std::string route_device;  ///< that multicast to the group leaves by; empty = no route
  bool loopback_up = false;
  bool loopback_multicast = false;
  bool delivered = false;      ///< a datagram to the group came back
  bool sealed = false;         ///< the processes have a key
  int64_t receive_buffer = 0;  ///< the largest one that the kernel grants, net.core.rmem_max [byte]
};

/// The device of an answer of `ip route get GROUP`; empty if there is no route.
std::string routeDevice(const std::string& answer);

/// An LCM URL that does, as an option.
std::string urlRemedy(bool simulated);

/// With ttl 0 messages must stay on the loopback device: there they also survive an unplugged
/// network cable. Where other hosts can send messages, there must be a key. A simulated launch may
/// go over another device or TCP (tcpq), as in a container.
std::vector<HostFinding> checkNetwork(const LcmAddress& address, const NetworkFacts& facts,
                                      bool simulated);

/// One process: what the host says about its program, configuration and device.
struct ProcessFacts {
  std::string name;
  std::string program;  ///< as in the launch file
  bool program_found = false;
  std::string config;  ///< path; empty = none
  bool config_readable = true;
  int check_code = 0;         ///< exit code of the program's --check
  std::string check_line;     ///< what it refused
  std::string configuration;  ///< what it takes it for, defaults included; empty if refused
  std::string device;         ///< path of a tty; empty = none
  bool device_present = true;
  bool device_usable = true;  ///< may be read and written
};

std::vector<HostFinding> checkProcess(const ProcessFacts& facts);

/// Patterns that the planner can never drive: it ends every plan standing on ground that it knows.
std::vector<HostFinding> checkReach(const PatternSet& patterns, double marking_range);

/// The tty that a process will open: of its last `--set address=`, else the configuration's
/// address; empty if there is none or if it lies in the run folder, where a process makes it.
std::string deviceOf(const std::vector<std::string>& arguments, const std::string& config_address,
                     const std::string& run);

/// What the host says about the run folder.
struct FolderFacts {
  std::string path;
  bool writable = false;
  int64_t free_bytes = 0;
  size_t longest_socket = 0;  ///< byte
  int owner = 0;              ///< pid of the tread-launch that runs in it; 0 = none
  bool occupied = false;      ///< somebody runs in it
  std::string foreign{};      ///< something in it that we may not write; empty = nothing
  std::string owner_of_foreign{};
  std::string
      no_folder{};  ///< a file, or a link to nothing, where a folder should be; empty = none
};

std::vector<HostFinding> checkFolder(const FolderFacts& facts);

}  // namespace tread::launch
