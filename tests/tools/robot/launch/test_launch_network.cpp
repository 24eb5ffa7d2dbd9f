// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The multicast checks with real hosts: network namespaces of this test.
#include <catch2/catch.hpp>

#include "tests/tools/robot/launch/launched.hpp"
#include "tools/robot/launch/host.hpp"

using namespace tread::testing;
using Catch::Contains;
using tread::launch::CommandOutcome;
using tread::launch::runCommand;

namespace {

CommandOutcome inOwnNetwork(const std::string& script) {
  return runCommand({"unshare", "--net", "--map-root-user", "sh", "-c", script}, 30.0);
}

}  // namespace

TEST_CASE("each mistake in the network is found, and its remedy mends it") {
  if (inOwnNetwork("ip link set lo up").code != 0) {
    WARN("network namespaces are not allowed here: not tested");
    return;
  }
  const Launched launched({"good"}, TREAD_STAND_IN, "");
  std::string check = std::string(TREAD_BIN_DIR) + "/tread-launch --check";
  for (const std::string& word : launched.arguments({"--lcm-url", "udpm://239.255.76.67:7667"}))
    check += " " + word;
  const CommandOutcome bare = inOwnNetwork(check);
  CHECK(bare.code == 1);
  CHECK_THAT(bare.output, Contains("trial: there is no route for LCM's multicast group"));
  const CommandOutcome deaf =
      inOwnNetwork("ip link set lo up; ip route add 224.0.0.0/4 dev lo; " + check);
  CHECK(deaf.code == 1);
  CHECK_THAT(deaf.output, Contains("trial: the loopback device lo has multicast off"));
  const std::string problem = withoutAdvice(bare.output).at(0);
  const size_t mend = problem.find("fix: ") + 5;
  const std::string remedy = problem.substr(mend, problem.find("  (as root)", mend) - mend);
  const CommandOutcome mended = inOwnNetwork(remedy + "; " + check);
  CHECK(mended.code == 0);
  CHECK_THAT(mended.output, Contains("trial: ready to start"));
}

TEST_CASE("multicast that would leave by a network card is refused where messages are to stay") {
  const std::string other =
      "ip link set lo up multicast on && ip tuntap add t0 mode tap && ip link set t0 up && "
      "ip addr add 10.9.9.1/24 dev t0 && ip route add 224.0.0.0/4 dev t0";
  if (inOwnNetwork(other).code != 0) {
    WARN("network namespaces or tap devices are not allowed here: not tested");
    return;
  }
  const Launched launched({"good"}, TREAD_STAND_IN, "");
  std::string check = std::string(TREAD_BIN_DIR) + "/tread-launch --check";
  for (const std::string& word : launched.arguments({"--lcm-url", "udpm://239.255.76.67:7667"}))
    check += " " + word;
  const CommandOutcome outcome = inOwnNetwork(other + " && " + check);
  CHECK(outcome.code == 1);
  CHECK_THAT(outcome.output, Contains("is routed to t0, so messages stop with that link"));
}
