// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <algorithm>

#include "tests/common/pattern/pattern_samples.hpp"
#include "tools/robot/launch/checks.hpp"
#include "tools/robot/launch/launch_file.hpp"

using namespace tread::launch;
using Catch::Contains;
using Catch::StartsWith;

namespace {

NetworkFacts goodNetwork() {
  NetworkFacts facts;
  facts.route_device = "lo";
  facts.loopback_up = true;
  facts.loopback_multicast = true;
  facts.delivered = true;
  facts.receive_buffer = 4194304;
  return facts;
}

/// The lines of all findings.
std::string lines(const std::vector<HostFinding>& findings) {
  std::string text;
  for (const HostFinding& finding : findings) text += findingLine("robot", finding) + "\n";
  return text;
}

std::string oneLine(const std::vector<HostFinding>& findings) {
  REQUIRE(findings.size() == 1);
  return lines(findings);
}

}  // namespace

TEST_CASE("LCM's URL is read as LCM reads it") {
  const auto plain = parseLcmUrl("udpm://");
  REQUIRE(plain);
  CHECK(plain->group == "239.255.76.67");
  CHECK(plain->port == 7667);
  CHECK(plain->ttl == 0);
  const auto full = parseLcmUrl("udpm://239.1.2.3:9000?ttl=1&recv_buf_size=5000000");
  REQUIRE(full);
  CHECK(full->group == "239.1.2.3");
  CHECK(full->port == 9000);
  CHECK(full->ttl == 1);
  CHECK(full->receive_buffer == 5000000);
  CHECK(parseLcmUrl("memq://")->provider == "memq");
  CHECK_FALSE(parseLcmUrl("239.1.2.3:9000"));
  CHECK_FALSE(parseLcmUrl("udpm://239.1.2.3:x"));
  CHECK_FALSE(parseLcmUrl("udpm://239.1.2.3:9000?ttl=zero"));
}

TEST_CASE("a good host has nothing to mend") {
  CHECK(checkNetwork({}, goodNetwork(), false).empty());
  NetworkFacts wide = goodNetwork();
  wide.route_device = "eth0";
  LcmAddress address;
  address.ttl = 1;
  wide.sealed = true;
  CHECK(checkNetwork(address, wide, false).empty());
  CHECK(checkProcess({"planner", "tread-planner", true, "p.yaml", true, 0, "", "", "", true, true})
            .empty());
  CHECK(checkFolder({"/run", true, 1'000'000'000'000, 20, 0, false}).empty());
}

TEST_CASE("multicast that is missing, elsewhere, off or filtered gives one line with its remedy") {
  const std::string remedy =
      "; fix: ip link set lo up multicast on; ip route replace 224.0.0.0/4 dev lo  (as root)\n";
  NetworkFacts facts = goodNetwork();
  facts.delivered = false;
  CHECK_THAT(oneLine(checkNetwork({}, facts, false)),
             Contains("did not come back; fix: look for a packet filter"));
  facts.route_device.clear();
  CHECK(oneLine(checkNetwork({}, facts, false)) ==
        "robot: there is no route for LCM's multicast group 239.255.76.67" + remedy);
  facts.route_device = "eth0";
  CHECK(oneLine(checkNetwork({}, facts, false)) ==
        "robot: LCM's multicast group 239.255.76.67 is routed to eth0, so messages stop with that "
        "link, though ttl is 0, and other hosts there can send them" +
            remedy);
  facts.sealed = true;
  CHECK_THAT(oneLine(checkNetwork({}, facts, false)), Contains("though ttl is 0; fix: "));
  facts.sealed = false;
  facts = goodNetwork();
  facts.loopback_multicast = false;
  CHECK(oneLine(checkNetwork({}, facts, false)) ==
        "robot: the loopback device lo has multicast off" + remedy);
  facts.loopback_up = false;
  CHECK(oneLine(checkNetwork({}, facts, false)) ==
        "robot: the loopback device lo is down" + remedy);
  facts.can_ask = false;
  CHECK(
      oneLine(checkNetwork({}, facts, false)) ==
      "robot: there is no program ip; fix: tools/setup, or apt-get install iproute2  (as root)\n");
  LcmAddress memory;
  memory.provider = "memq";
  CHECK_THAT(oneLine(checkNetwork(memory, facts, false)), Contains("memq does not connect"));
}

TEST_CASE("a port that other hosts reach needs a key, or the route by the loopback device") {
  NetworkFacts facts = goodNetwork();
  LcmAddress address;
  address.ttl = 1;
  CHECK(checkNetwork(address, facts, false).empty());  // sent messages stay on lo
  facts.route_device = "wlan0";
  CHECK(oneLine(checkNetwork(address, facts, false)) ==
        "robot: LCM's port 7667 can be reached from outside by wlan0 (ttl is 1), and without a key "
        "everybody there can arm and drive the robot; fix: leave key: none out of the launch "
        "file; or for one host ttl=0 and ip link set lo up multicast on; ip route "
        "replace 224.0.0.0/4 dev lo  (as root)\n");
  CHECK_FALSE(anyCritical(checkNetwork(address, facts, true)));
  facts.sealed = true;
  CHECK(checkNetwork(address, facts, false).empty());
}

TEST_CASE("a simulated launch goes over what there is") {
  NetworkFacts facts = goodNetwork();
  facts.route_device = "eth0";
  CHECK_THAT(oneLine(checkNetwork({}, facts, true)),
             StartsWith("robot: advice: LCM's multicast group 239.255.76.67 is routed to eth0"));
  facts.can_ask = false;
  facts.route_device.clear();
  CHECK(checkNetwork({}, facts, true).empty());
  facts.can_ask = true;
  const std::string without_route = oneLine(checkNetwork({}, facts, true));
  CHECK_THAT(without_route, StartsWith("robot: there is no route") &&
                                Contains("or without root: --lcm-url tcpq://127.0.0.1:7668"));
  const auto tcp = parseLcmUrl("tcpq://127.0.0.1:7668");
  REQUIRE(tcp);
  CHECK(tcp->port == 7668);
  CHECK(checkNetwork(*tcp, {}, true).empty());
  CHECK(anyCritical(checkNetwork(*tcp, {}, false)));
  CHECK(anyCritical(checkNetwork(*parseLcmUrl("tcpq://192.0.2.1"), {}, true)));
}

TEST_CASE("a small receive buffer is an advice, not an obstacle") {
  NetworkFacts facts = goodNetwork();
  facts.receive_buffer = 212992;
  const auto findings = checkNetwork({}, facts, false);
  CHECK_FALSE(anyCritical(findings));
  CHECK_THAT(oneLine(findings), StartsWith("robot: advice: net.core.rmem_max is 212992") &&
                                    Contains("sysctl -w net.core.rmem_max=2097152"));
}

TEST_CASE("the route is read from what ip says") {
  CHECK(routeDevice("multicast 239.255.76.67 dev lo src 192.0.2.2 uid 0 \n    cache <mc>") == "lo");
  CHECK(routeDevice("multicast 239.255.76.67 via 192.0.2.1 dev eth0 src 192.0.2.2") == "eth0");
  CHECK(routeDevice("RTNETLINK answers: Network is unreachable").empty());
}

TEST_CASE("a process's program, configuration and device are named when they are missing") {
  ProcessFacts facts{"planner", "tread-planner", false, "p.yaml", true, 0, "", "", "", true, true};
  CHECK(oneLine(checkProcess(facts)) ==
        "robot: planner: there is no program tread-planner; fix: tools/build\n");
  facts.program_found = true;
  facts.config_readable = false;
  CHECK_THAT(oneLine(checkProcess(facts)), StartsWith("robot: planner: p.yaml cannot be read"));
  facts.config_readable = true;
  facts.check_code = 1;
  facts.check_line = "p.yaml:3: lease is 9 s; allowed 0.05..1 s";
  CHECK(oneLine(checkProcess(facts)) ==
        "robot: planner: p.yaml:3: lease is 9 s; allowed 0.05..1 s; fix: edit p.yaml\n");
  facts.check_code = 0;
  facts.configuration = "# warning: p.yaml:4: memory: nothing reads it\nlease: 1\n";
  CHECK(oneLine(checkProcess(facts)) ==
        "robot: advice: planner: p.yaml:4: memory: nothing reads it; fix: edit p.yaml\n");
  facts.configuration.clear();
  facts.device = "/dev/ttyUSB0";
  facts.device_present = false;
  CHECK_FALSE(anyCritical(checkProcess(facts)));
  CHECK_THAT(oneLine(checkProcess(facts)),
             StartsWith("robot: advice: planner: device /dev/ttyUSB0 is absent"));
  facts.device_present = true;
  facts.device_usable = false;
  CHECK_THAT(oneLine(checkProcess(facts)), Contains("usermod -a -G dialout"));
}

TEST_CASE("patterns that need more ground than is marked are told, with what they need") {
  std::string why;
  const std::optional<tread::PatternSet> set =
      tread::PatternSet::make(tread::testing::goodContent(), why);
  REQUIRE(set);
  CHECK(checkReach(*set, 1.0).empty());
  const std::vector<HostFinding> findings = checkReach(*set, 0.1);
  CHECK_FALSE(anyCritical(findings));
  CHECK_THAT(oneLine(findings), StartsWith("robot: advice: 1 of 3 patterns (left) are out of use: "
                                           "from standstill to standstill they need up to 0.2 m"));
}

TEST_CASE("the device is that of the last --set, else of the configuration, and a tty") {
  CHECK(deviceOf({}, "tty:/dev/ttyUSB0?baud=9600", "/run") == "/dev/ttyUSB0");
  CHECK(deviceOf({"--set", "address=tty:/dev/a"}, "tty:/dev/b", "/run") == "/dev/a");
  CHECK(deviceOf({"--set=address=tty:/dev/a", "--set=address=tcp:x:1"}, "", "/run").empty());
  CHECK(deviceOf({"--set", "address=tty:/run/devices/ins"}, "", "/run").empty());
  CHECK(deviceOf({}, "nonsense", "/run").empty());
  CHECK(deviceOf({"--set"}, "", "/run").empty());
}

TEST_CASE("a run folder's name that addresses cannot hold, and another user's state, are named") {
  FolderFacts facts;
  facts.writable = true;
  facts.free_bytes = 10'000'000'000;
  for (const char* good : {"/run/100% free", "/run/it's \"mine\"", "/run/a;b#1", "/run/a:b"}) {
    facts.path = good;
    CHECK(checkFolder(facts).empty());
  }
  for (const char* bad : {"/run/a?b", "/run/a: b", "/run/a #b", "/run/a\tb"}) {
    facts.path = bad;
    CHECK_THAT(oneLine(checkFolder(facts)), Contains("cannot hold; fix: use another folder"));
  }
  facts.path = "/run/r";
  facts.foreign = "/run/r/state/learner";
  facts.owner_of_foreign = "root";
  CHECK_THAT(oneLine(checkFolder(facts)),
             Contains("/run/r/state/learner belongs to root and cannot be written; fix: chown -R"));
}

TEST_CASE("a run folder that cannot serve gives one line") {
  FolderFacts facts{"/run/r", true, 1'000'000'000, 20, 0, false};
  CHECK_THAT(oneLine(checkFolder(facts)), StartsWith("robot: advice: only 1000 MB are free"));
  facts.free_bytes = 1'000'000;
  CHECK(anyCritical(checkFolder(facts)));
  facts.writable = false;
  CHECK_THAT(oneLine(checkFolder(facts)), Contains("/run/r cannot be written; fix: mkdir -p"));
  facts.writable = true;
  facts.free_bytes = 1'000'000'000'000;
  facts.longest_socket = kMaxSocketPath + 3;
  CHECK_THAT(oneLine(checkFolder(facts)), Contains("3 bytes too long"));
  facts.occupied = true;
  facts.owner = 77;
  CHECK_THAT(oneLine(checkFolder(facts)), StartsWith("robot: runs already in /run/r (pid 77)"));
}
