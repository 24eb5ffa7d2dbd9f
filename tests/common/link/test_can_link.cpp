// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <stdexcept>

#include <catch2/catch.hpp>

#include "common/link/make_link.hpp"

using namespace tread;

TEST_CASE("a CAN interface is an address of its own") {
  const LinkAddress address = parseLinkAddress("can:can0");
  CHECK(address.kind == LinkAddress::Kind::kCan);
  CHECK(address.path == "can0");
  CHECK_THROWS_AS(parseLinkAddress("can:"), std::invalid_argument);
  CHECK_THROWS_AS(parseLinkAddress("can:an-interface-of-too-long-a-name"), std::invalid_argument);
}

TEST_CASE("a CAN interface that is not there is told in one line, and tried again") {
  const auto link = makeLink("can:tread-none");
  CHECK_FALSE(link->isOpen());
  CHECK(link->problem().rfind("can:tread-none: ", 0) == 0);
  CHECK(link->problem().find('\n') == std::string::npos);
  CHECK_FALSE(link->reopen(1'000'000));
  const uint8_t frame[16] = {};
  CHECK_FALSE(link->write(frame, sizeof frame));
}

TEST_CASE("frames pass between two ends of a CAN interface") {
  const auto one = makeLink("can:vcan0");
  const auto other = makeLink("can:vcan0");
  if (!one->isOpen()) {
    WARN("skipped: no vcan0 here (ip link add vcan0 type vcan; ip link set vcan0 up): "
         << one->problem());
    return;
  }
  uint8_t frames[32] = {1, 0, 0, 0x80, 2, 0, 0, 0, 7, 8};
  frames[16] = 2;
  frames[19] = 0x80;
  REQUIRE(one->write(frames, sizeof frames));
  uint8_t heard[64];
  size_t count = 0;
  while (count < 32) {
    const auto read = other->read(heard + count, sizeof heard - count);
    REQUIRE(read);
    count += *read;
  }
  CHECK(std::equal(frames, frames + 10, heard));
  CHECK(heard[16] == 2);
}
