// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <vector>

#include "common/link/descriptor_link.hpp"
#include "common/link/make_link.hpp"

namespace tread {

TEST_CASE("failed attempts are spaced by 100 ms, doubling to 1 s") {
  BackOff back_off;
  std::vector<int64_t> made;
  for (int64_t utime = 5'000'000; utime < 10'000'000; utime += 10'000) {
    if (!back_off.attempt(utime)) continue;
    made.push_back((utime - 5'000'000) / 1000);
    back_off.failed();
  }
  CHECK(made == std::vector<int64_t>{0, 100, 300, 700, 1500, 2500, 3500, 4500});
}

TEST_CASE("a peer that accepts and hangs up at once is called ten times a second at most") {
  BackOff back_off;
  int made = 0;
  for (int64_t utime = 0; utime < 1'000'000; utime += 1'000) {
    if (!back_off.attempt(utime)) continue;
    ++made;
    back_off.succeeded();
  }
  CHECK(made == 10);
}

TEST_CASE("a clock that starts anew does not lock a link out") {
  BackOff back_off;
  CHECK(back_off.attempt(1'000'000'000));
  CHECK(back_off.attempt(5));
}

TEST_CASE("reopen of an absent device keeps to the spacing and says what is missing") {
  const auto link = makeLink("tty:/dev/tread_no_such_device");
  CHECK_FALSE(link->isOpen());
  CHECK(link->descriptor() == -1);
  CHECK(link->problem() == "tty:/dev/tread_no_such_device: No such file or directory");
  CHECK_FALSE(link->reopen(1'000'000));
  uint8_t byte = 0;
  CHECK_FALSE(link->read(&byte, 1));
  CHECK_FALSE(link->write(&byte, 1));
}

}  // namespace tread
