// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cstdio>
#include <fstream>

#include <catch2/catch.hpp>

#include "common/link/make_link.hpp"
#include "link_helpers.hpp"

namespace tread {
namespace {

std::string temporary() {
  return "/tmp/tread_link_" + std::to_string(::getpid()) + ".nmea";
}

}  // namespace

TEST_CASE("a file is read once, to its end, and never written") {
  std::ofstream(temporary()) << "$GPGGA,1\n$GPGGA,2\n";
  const auto link = makeLink("file:" + temporary());
  REQUIRE(link->isOpen());
  CHECK(link->problem().empty());
  CHECK_FALSE(testing::send(*link, "x"));
  CHECK(testing::receive(*link, 18) == "$GPGGA,1\n$GPGGA,2\n");
  uint8_t byte = 0;
  CHECK_FALSE(link->read(&byte, 1));
  CHECK_FALSE(link->isOpen());
  CHECK(link->problem() == "file:" + temporary() + ": the file is at its end");
  CHECK_FALSE(link->reopen(100'000'000));
  std::remove(temporary().c_str());
}

TEST_CASE("a file that is not there yet is opened when it is") {
  std::remove(temporary().c_str());
  const auto link = makeLink("file:" + temporary());
  CHECK_FALSE(link->reopen(1'000'000));
  std::ofstream(temporary()) << "abc";
  CHECK_FALSE(link->reopen(1'050'000));
  CHECK(link->reopen(1'100'000));
  CHECK(testing::receive(*link, 3) == "abc");
  std::remove(temporary().c_str());
}

TEST_CASE("a folder is no file to read") {
  const auto link = makeLink("file:/tmp");
  CHECK_FALSE(link->isOpen());
  CHECK(link->problem() == "file:/tmp: Is a directory");
}

}  // namespace tread
