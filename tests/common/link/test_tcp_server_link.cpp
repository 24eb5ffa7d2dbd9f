// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "common/link/make_link.hpp"
#include "tests/common/link/link_helpers.hpp"

namespace tread {

using testing::comesBack;
using testing::receive;
using testing::send;

namespace {

/// A server on a free port, returned in `port`.
std::unique_ptr<Link> serve(int& port) {
  for (port = 20000 + static_cast<int>(::getpid() % 20000);; ++port) {
    auto server = makeLink("tcp-server:127.0.0.1:" + std::to_string(port));
    if (server->problem().find("nobody has connected") != std::string::npos) return server;
  }
}

}  // namespace

TEST_CASE("an emulated TCP device talks to one robot at a time, and to the next after it") {
  int port = 0;
  const auto device = serve(port);
  int64_t device_time = 1'000'000;
  int64_t robot_time = 1'000'000;
  for (int i = 0; i < 2; ++i) {
    if (i == 1) CHECK(testing::noticesEnd(*device));
    const auto robot = makeLink("tcp:127.0.0.1:" + std::to_string(port));
    REQUIRE(comesBack(*robot, robot_time));
    REQUIRE(comesBack(*device, device_time));
    REQUIRE(send(*robot, "QT\n"));
    CHECK(receive(*device, 3) == "QT\n");
    REQUIRE(send(*device, "QT\n00P\n\n"));
    CHECK(receive(*robot, 8) == "QT\n00P\n\n");
    device_time += 1'000'000;
    robot_time += 1'000'000;
    if (i == 1) {
      CHECK(device->isOpen());
      const auto second = makeLink("tcp:127.0.0.1:" + std::to_string(port));
      CHECK(send(*robot, "BM\n"));
      CHECK(receive(*device, 3) == "BM\n");
    }
  }
  CHECK(testing::noticesEnd(*device));
}

TEST_CASE("a port that is taken is said") {
  int port = 0;
  const auto device = serve(port);
  const auto second = makeLink("tcp-server:127.0.0.1:" + std::to_string(port));
  CHECK_FALSE(second->isOpen());
  CHECK_THAT(second->problem(), Catch::Contains("in use"));
}

}  // namespace tread
