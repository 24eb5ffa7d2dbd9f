// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <stdexcept>

#include <catch2/catch.hpp>

#include "common/link/make_link.hpp"

namespace tread {

using Catch::Contains;

TEST_CASE("addresses are taken apart") {
  const LinkAddress tty = parseLinkAddress("tty:/dev/serial/by-id/x?baud=57600");
  CHECK(tty.path == "/dev/serial/by-id/x");
  CHECK(tty.baud == 57600);
  CHECK(parseLinkAddress("tty:/dev/ttyUSB0").baud == 115200);
  const LinkAddress tcp = parseLinkAddress("tcp:192.168.0.10:10940");
  CHECK(tcp.host == "192.168.0.10");
  CHECK(tcp.port == 10940);
  CHECK(parseLinkAddress("tcp:[::1]:80").host == "::1");
  CHECK(parseLinkAddress("udp:5000").port == 5000);
  CHECK(parseLinkAddress("udp:127.0.0.1:5000").host == "127.0.0.1");
  CHECK(parseLinkAddress("pty:devices/ins").path == "devices/ins");
  CHECK(parseLinkAddress("tcp-server:10940").port == 10940);
  CHECK(parseLinkAddress("tcp-server:127.0.0.1:10940").host == "127.0.0.1");
  CHECK(parseLinkAddress("file:/tmp/a:b").path == "/tmp/a:b");
}

TEST_CASE("a malformed address is one clear line with what is allowed") {
  CHECK_THROWS_WITH(makeLink("serial:/dev/ttyUSB0"),
                    Contains("link address \"serial:/dev/ttyUSB0\": unknown kind; allowed tty:"));
  for (const char* bad : {"",
                          "tty",
                          "/dev/ttyUSB0",
                          "tty:",
                          "tty:?baud=9600",
                          "tty:/dev/x?speed=1",
                          "tty:/dev/x?baud=",
                          "tty:/dev/x?baud=9601",
                          "tty:/dev/x?baud=9600x",
                          "pty:",
                          "tcp-server:",
                          "tcp-server:0",
                          "tcp:",
                          "tcp:host",
                          "tcp::5",
                          "tcp:host:",
                          "tcp:host:0",
                          "tcp:host:65536",
                          "tcp:host:-1",
                          "tcp:host:1e3",
                          "udp:",
                          "udp:x",
                          "udp:70000",
                          "file:"}) {
    INFO(bad);
    CHECK_THROWS_AS(makeLink(bad), std::invalid_argument);
  }
}

}  // namespace tread
