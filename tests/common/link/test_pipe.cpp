// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <stdexcept>

#include "common/link/make_link.hpp"
#include "link_helpers.hpp"

namespace tread {

using testing::receive;
using testing::send;

TEST_CASE("bytes go both ways in order, any piece at a time") {
  auto [a, b] = makePipe();
  CHECK(send(*a, "hello "));
  CHECK(send(*a, "there"));
  CHECK(send(*b, "back"));
  uint8_t byte = 0;
  CHECK(b->read(&byte, 1) == 1);
  CHECK(byte == 'h');
  CHECK(receive(*b, 10) == "ello there");
  CHECK(receive(*a, 4) == "back");
  CHECK(b->read(&byte, 1) == 0);
  CHECK(a->read(&byte, 0) == 0);
}

TEST_CASE("each direction is bounded, and a write that does not fit is not begun") {
  auto [a, b] = makePipe(8);
  CHECK(send(*a, "12345"));
  CHECK_FALSE(send(*a, "6789"));
  CHECK(send(*a, "678"));
  CHECK_FALSE(send(*a, "9"));
  CHECK(send(*b, "12345678"));
  CHECK(receive(*b, 8) == "12345678");
  CHECK(send(*a, "9"));
  CHECK(a->isOpen());
}

TEST_CASE("a cut plug closes both ends, from either end, and unread bytes are gone") {
  for (const int cutting : {0, 1}) {
    auto [a, b] = makePipe();
    Link& end = cutting == 0 ? *a : *b;
    send(*a, "unread");
    setPipeConnected(end, false);
    uint8_t byte = 0;
    CHECK_FALSE(a->read(&byte, 1));
    CHECK_FALSE(b->read(&byte, 1));
    CHECK_FALSE(send(*a, "x"));
    CHECK_FALSE(a->isOpen());
    CHECK_FALSE(a->reopen(1));
    CHECK(a->problem() == "pipe:0: unplugged");
    setPipeConnected(end, true);
    CHECK_FALSE(a->isOpen());
    CHECK(a->reopen(2));
    CHECK(b->reopen(2));
    CHECK(b->read(&byte, 1) == 0);
    CHECK(send(*a, "y"));
    CHECK(receive(*b, 1) == "y");
    CHECK(a->problem().empty());
  }
}

TEST_CASE("a plug pulled and put back between two looks is still noticed") {
  auto [a, b] = makePipe();
  setPipeConnected(*a, false);
  setPipeConnected(*a, true);
  CHECK_FALSE(a->isOpen());
  CHECK_FALSE(b->isOpen());
  CHECK(a->reopen(1));
  CHECK(send(*a, "kept until the other end is open"));
  CHECK(b->reopen(1));
  CHECK(receive(*b, 32) == "kept until the other end is open");
}

TEST_CASE("an end whose other end is gone is down") {
  auto [a, b] = makePipe();
  b.reset();
  CHECK_FALSE(a->isOpen());
  CHECK_FALSE(a->reopen(1));
}

TEST_CASE("only a pipe can be cut") {
  const auto link = makeLink("file:/dev/null");
  CHECK_THROWS_AS(setPipeConnected(*link, false), std::invalid_argument);
}

}  // namespace tread
