// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/launch/checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>
#include <stdexcept>

#include "common/link/make_link.hpp"
#include "common/report/text.hpp"
#include "tools/robot/launch/launch_file.hpp"

namespace tread::launch {
namespace {

constexpr int64_t kWantedSpace = 2'000'000'000;  // about an hour of logs
constexpr int64_t kNeededSpace = 20'000'000;     // for the states and a short log
constexpr int kMostNames = 4;                    // pattern names in one line
constexpr const char* kRouteRemedy =
    "ip link set lo up multicast on; ip route replace 224.0.0.0/4 dev lo  (as root)";
constexpr const char* kRemedyWithoutRoot = "; or without root: --lcm-url tcpq://127.0.0.1:7668";

bool isUtf8(const std::string& text) {
  size_t following = 0;
  for (const unsigned char c : text) {
    if (following > 0 ? (c >> 6) != 2 : (c >> 6) == 2 || c > 0xF4) return false;
    following = following > 0 ? following - 1 : c < 0xC0 ? 0 : c < 0xE0 ? 1 : c < 0xF0 ? 2 : 3;
  }
  return following == 0;
}

/// Characters of a path that process arguments, YAML or link addresses would misread; empty if
/// none.
std::string unusable(const std::string& path) {
  if (std::any_of(path.begin(), path.end(), [](unsigned char c) { return c < ' ' || c == 127; }))
    return "a control character";
  if (!isUtf8(path)) return "bytes that are no UTF-8";
  for (const auto& [part, name] : {std::pair{"?", "a question mark"},
                                   {": ", "a colon before a blank"},
                                   {" #", "a # behind a blank"}})
    if (path.find(part) != std::string::npos) return name;
  return "";
}

std::string megabytes(int64_t bytes) {
  return std::to_string(bytes / 1'000'000) + " MB";
}

}  // namespace

std::string findingLine(const std::string& launch_name, const HostFinding& finding) {
  return launch_name + (finding.critical ? ": " : ": advice: ") + finding.problem +
         "; fix: " + finding.remedy;
}

bool anyCritical(const std::vector<HostFinding>& findings) {
  return std::any_of(findings.begin(), findings.end(),
                     [](const HostFinding& finding) { return finding.critical; });
}

std::string routeDevice(const std::string& answer) {
  std::istringstream words(answer);
  std::string word;
  while (words >> word)
    if (word == "dev" && words >> word) return word;
  return "";
}

namespace {

/// Problem with multicast to the LCM group; empty if none.
std::string multicastProblem(const LcmAddress& address, const NetworkFacts& facts) {
  if (facts.can_ask && facts.route_device.empty())
    return "there is no route for LCM's multicast group " + address.group;
  if (facts.route_device == "lo" && !facts.loopback_up) return "the loopback device lo is down";
  if (facts.route_device == "lo" && !facts.loopback_multicast)
    return "the loopback device lo has multicast off";
  return "";
}

HostFinding openToOthers(const LcmAddress& address, const std::string& device, bool simulated) {
  return {!simulated,
          "LCM's port " + std::to_string(address.port) + " can be reached from outside by " +
              device + " (ttl is " + std::to_string(address.ttl) +
              "), and without a key everybody there can arm and drive the robot",
          "leave key: none out of the launch file; or for one host ttl=0 and " +
              std::string(kRouteRemedy)};
}

HostFinding smallBuffer(int64_t granted, int64_t wanted) {
  return {false,
          "net.core.rmem_max is " + std::to_string(granted) + ", so bursts of messages are lost",
          "sysctl -w net.core.rmem_max=" + std::to_string(wanted) +
              "  (as root; for good: config/sysctl/60-tread.conf)"};
}

}  // namespace

std::string urlRemedy(bool simulated) {
  // A simulated robot uses another port than a real one.
  return "--lcm-url udpm://239.255.76.67:" + std::string(simulated ? "7668" : "7667") + "?ttl=0";
}

std::vector<HostFinding> checkNetwork(const LcmAddress& address, const NetworkFacts& facts,
                                      bool simulated) {
  if (address.provider == "tcpq" && address.group == "127.0.0.1" && simulated) return {};
  if (address.provider == "tcpq")
    return {{true, "LCM URL with provider tcpq is for simulated launches, on 127.0.0.1",
             urlRemedy(simulated)}};
  if (address.provider != "udpm")
    return {{true,
             "LCM URL with provider " + address.provider + " does not connect these processes",
             urlRemedy(simulated)}};
  if (!facts.can_ask && !(simulated && facts.delivered)) return {missingTool("ip", "iproute2")};
  std::vector<HostFinding> findings;
  const std::string problem = multicastProblem(address, facts);
  const bool elsewhere =
      address.ttl == 0 && !facts.route_device.empty() && facts.route_device != "lo";
  if (!problem.empty())
    findings.push_back(
        {true, problem, std::string(kRouteRemedy) + (simulated ? kRemedyWithoutRoot : "")});
  else if (elsewhere && (facts.delivered || !simulated))
    findings.push_back({!simulated,
                        "LCM's multicast group " + address.group + " is routed to " +
                            facts.route_device +
                            ", so messages stop with that link, though ttl is 0" +
                            (facts.sealed ? "" : ", and other hosts there can send them"),
                        kRouteRemedy});
  else if (!facts.delivered)
    findings.push_back(
        {true,
         "a datagram sent to " + address.group + " by " + facts.route_device + " did not come back",
         std::string("look for a packet filter: nft list ruleset  (as root)") +
             (simulated ? kRemedyWithoutRoot : "")});
  if (address.ttl > 0 && !facts.sealed && !facts.route_device.empty() && facts.route_device != "lo")
    findings.push_back(openToOthers(address, facts.route_device, simulated));
  const int64_t wanted = std::max(kWantedBuffer, address.receive_buffer);
  if (facts.receive_buffer < wanted) findings.push_back(smallBuffer(facts.receive_buffer, wanted));
  return findings;
}

std::vector<HostFinding> checkProcess(const ProcessFacts& facts) {
  std::vector<HostFinding> findings;
  if (!facts.program_found)
    findings.push_back(
        {true, facts.name + ": there is no program " + facts.program,
         facts.program.rfind("lcm-", 0) == 0 ? "apt-get install liblcm-bin" : "tools/build"});
  if (!facts.config.empty() && !facts.config_readable)
    findings.push_back({true, facts.name + ": " + facts.config + " cannot be read",
                        "check the path and the rights, or name another file"});
  else if (facts.check_code != 0)
    findings.push_back({true,
                        facts.name + ": " +
                            (facts.check_line.empty()
                                 ? "--check ended with code " + std::to_string(facts.check_code)
                                 : facts.check_line),
                        facts.config.empty() ? "correct the launch file" : "edit " + facts.config});
  constexpr const char* kWarning = "# warning: ";
  std::istringstream lines(facts.configuration);
  for (std::string line; std::getline(lines, line);)
    if (line.rfind(kWarning, 0) == 0)
      findings.push_back(
          {false, facts.name + ": " + line.substr(std::strlen(kWarning)),
           facts.config.empty() ? "correct the launch file" : "edit " + facts.config});
  const std::string device = facts.name + ": device " + facts.device;
  if (facts.device.empty()) return findings;
  if (!facts.device_present)
    findings.push_back({false, device + " is absent; it is tried again and again",
                        "plug it in, or change address" +
                            (facts.config.empty() ? std::string() : " in " + facts.config)});
  else if (!facts.device_usable)
    findings.push_back({false, device + " may not be read and written",
                        "usermod -a -G dialout USER  (as root), then log in again"});
  return findings;
}

std::vector<HostFinding> checkReach(const PatternSet& patterns, double marking_range) {
  const std::vector<double> lengths = restToRestLengths(patterns);
  std::string names;
  int too_long = 0;
  double longest = 0.0;
  for (size_t i = 0; i < lengths.size(); ++i) {
    if (!std::isfinite(lengths[i]) || lengths[i] <= marking_range) continue;
    if (++too_long <= kMostNames)
      names += (names.empty() ? "" : ", ") + patterns.patterns()[i].name;
    longest = std::max(longest, lengths[i]);
  }
  if (too_long == 0) return {};
  if (too_long > kMostNames) names += ", ...";
  return {{false,
           std::to_string(too_long) + " of " + std::to_string(lengths.size()) + " patterns (" +
               names + ") are out of use: from standstill to standstill they need up to " +
               fixed(longest, 1) + " m, and obstacles are marked to " + fixed(marking_range, 1) +
               " m",
           "marking_range of mapping.yaml, if the range finder sees obstacles so far; or slower "
           "patterns"}};
}

std::string deviceOf(const std::vector<std::string>& arguments, const std::string& config_address,
                     const std::string& run) {
  std::string text = config_address;
  for (size_t i = 0; i < arguments.size(); ++i) {
    std::string set;
    if (arguments[i] == "--set" && i + 1 < arguments.size()) set = arguments[i + 1];
    if (arguments[i].rfind("--set=", 0) == 0) set = arguments[i].substr(6);
    if (set.rfind("address=", 0) == 0) text = set.substr(8);
  }
  if (text.empty()) return "";
  try {
    const LinkAddress address = parseLinkAddress(text);
    if (address.kind != LinkAddress::Kind::kTty) return "";
    return address.path.rfind(run + "/", 0) == 0 ? "" : address.path;
  } catch (const std::invalid_argument&) {
    return "";  // the program's own --check reports the problem
  }
}

std::vector<HostFinding> checkFolder(const FolderFacts& facts) {
  std::vector<HostFinding> findings;
  if (facts.occupied) {
    const std::string owner = facts.owner > 0 ? " (pid " + std::to_string(facts.owner) + ")" : "";
    findings.push_back({true, "runs already in " + facts.path + owner,
                        "stop it with --stop, or use another folder with --run"});
    return findings;
  }
  if (facts.longest_socket > kMaxSocketPath)
    findings.push_back({true,
                        "the path " + facts.path + " is " +
                            std::to_string(facts.longest_socket - kMaxSocketPath) +
                            " bytes too long for the socket in it",
                        "use a shorter folder with --run"});
  if (!facts.no_folder.empty()) {
    findings.push_back({true, facts.no_folder + " is a file or a link to nothing, not a folder",
                        "move it away, or use another folder with --run"});
    return findings;
  }
  if (!facts.writable) {
    findings.push_back({true, "the run folder " + facts.path + " cannot be written",
                        "mkdir -p " + facts.path + "; chown it to yourself; or use --run DIR"});
    return findings;
  }
  if (const std::string why = unusable(facts.path); !why.empty())
    findings.push_back({true,
                        "the path " + facts.path + " has " + why +
                            ", which addresses of devices in it cannot hold",
                        "use another folder with --run"});
  if (!facts.foreign.empty())
    findings.push_back(
        {true, facts.foreign + " belongs to " + facts.owner_of_foreign + " and cannot be written",
         "chown -R USER " + facts.path + "  (as root); or use another folder with --run"});
  if (facts.free_bytes < kWantedSpace)
    findings.push_back(
        {facts.free_bytes < kNeededSpace,
         "only " + megabytes(facts.free_bytes) + " are free for logs in " + facts.path,
         "remove old logs, or use another disk with --run"});
  return findings;
}

HostFinding missingTool(const std::string& tool, const std::string& package) {
  return {true, "there is no program " + tool,
          "tools/setup, or apt-get install " + package + "  (as root)"};
}

}  // namespace tread::launch
