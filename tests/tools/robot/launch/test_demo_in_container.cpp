// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The demo's launch in a container that does not permit network namespaces.
#include <catch2/catch.hpp>

#include "tests/tools/robot/launch/launched.hpp"
#include "tools/robot/launch/host.hpp"

using namespace tread::testing;
using Catch::Contains;
using tread::launch::CommandOutcome;
using tread::launch::runCommand;
namespace fs = std::filesystem;

namespace {

/// The loopback device has no route for multicast; a device like eth0 has one.
const std::string kContainer =
    "ip link set lo up && ip link add e0 type veth peer name e1 && ip link set e0 up && "
    "ip link set e1 up && ip addr add 10.9.9.1/24 dev e0 && ip route add default dev e0";
const std::string kNoMulticast = "ip link set lo up";

bool allowed(const std::string& network) {
  return runCommand({"unshare", "--net", "--map-root-user", "sh", "-c", network}, 10.0).code == 0;
}

/// A short drive of tools/demo in a network made by this script, without unshare in PATH.
CommandOutcome shortDrive(const std::string& network) {
  const fs::path folder =
      fs::temp_directory_path() / ("tread_container_" + std::to_string(getpid()));
  fs::create_directories(folder / "bin");
  fs::create_directories(folder / "run");
  const std::string script =
      network + " && cp -s /usr/bin/* /usr/sbin/* " + (folder / "bin").string() +
      " 2>/dev/null; rm " + (folder / "bin/unshare").string() +
      "; cd " TREAD_SOURCE_DIR " && PATH=" + (folder / "bin").string() +
      " TREAD_BIN=" TREAD_BIN_DIR " tools/demo --drive " + (folder / "run").string() + " -9.8 -2.8";
  CommandOutcome outcome =
      runCommand({"unshare", "--net", "--map-root-user", "sh", "-c", script}, 150.0);
  std::error_code none;
  for (const auto& log : fs::directory_iterator(folder / "run/log", none))
    if (log.path().extension() == ".log" && outcome.code != 0)
      outcome.output += "\n" + log.path().filename().string() + ":\n" + contentOf(log);
  fs::remove_all(folder);
  return outcome;
}

}  // namespace

TEST_CASE("in a container without a network of its own the demo goes over what there is") {
  if (!allowed(kContainer)) {
    WARN("network namespaces are not allowed here: not tested");
    return;
  }
  const CommandOutcome drive = shortDrive(kContainer);
  INFO(drive.output);
  CHECK(drive.code == 0);
  CHECK_THAT(drive.output, Contains("simulated: advice: LCM's multicast group 239.255.76.67 is "
                                    "routed to e0") &&
                               Contains("tread-arm: armed") && Contains("arrived"));
}

TEST_CASE("without any multicast the demo goes over TCP") {
  if (!allowed(kNoMulticast)) {
    WARN("network namespaces are not allowed here: not tested");
    return;
  }
  const CommandOutcome drive = shortDrive(kNoMulticast);
  INFO(drive.output);
  CHECK(drive.code == 0);
  CHECK_THAT(drive.output, Contains("messages go over tcpq://127.0.0.1:7668") &&
                               Contains("tread-arm: armed") && Contains("arrived"));
}
