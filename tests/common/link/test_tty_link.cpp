// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <fcntl.h>
#include <sys/stat.h>
#include <termios.h>

#include <cerrno>
#include <cstdlib>
#include <utility>

#include <catch2/catch.hpp>

#include "common/link/make_link.hpp"
#include "link_helpers.hpp"

namespace tread {
namespace {

using testing::comesBack;
using testing::noticesEnd;
using testing::receive;
using testing::send;

/// The device's side of a serial line: the master of a pseudo-terminal under a fixed symlink.
class Device {
 public:
  Device() : name("/tmp/tread_tty_" + std::to_string(::getpid())) { plugIn(); }
  ~Device() { unplug(); }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  void plugIn() {
    master = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
    ::grantpt(master);
    ::unlockpt(master);
    const std::string next = name + ".next";
    ::unlink(next.c_str());
    REQUIRE(::symlink(::ptsname(master), next.c_str()) == 0);
    REQUIRE(::rename(next.c_str(), name.c_str()) == 0);
  }
  void unplug() {
    if (master >= 0) ::close(std::exchange(master, -1));
    ::unlink(name.c_str());
  }
  void say(const std::string& text) const {
    REQUIRE(::write(master, text.data(), text.size()) == static_cast<ssize_t>(text.size()));
  }
  std::string hear(size_t size) const {
    std::string text;
    for (int i = 0; i < 5000 && text.size() < size; ++i) {
      char buffer[4096];
      const ssize_t count = ::read(master, buffer, sizeof buffer);
      if (count > 0) text.append(buffer, static_cast<size_t>(count));
      if (count <= 0) ::usleep(200);
    }
    return text;
  }
  std::string link() const { return "tty:" + name + "?baud=57600"; }

  std::string name;
  int master = -1;
};

}  // namespace

TEST_CASE("a serial line carries every byte both ways, unchanged and without echo") {
  const Device device;
  const auto link = makeLink(device.link());
  REQUIRE(link->isOpen());
  std::string all;
  for (int i = 0; i < 256; ++i) all += static_cast<char>(i);
  CHECK(send(*link, all));
  CHECK(device.hear(256) == all);
  device.say(all);
  CHECK(receive(*link, 256) == all);
  uint8_t byte = 0;
  CHECK(link->read(&byte, 1) == 0);
}

TEST_CASE("the line is raw at the rate asked for") {
  const Device device;
  const auto link = makeLink(device.link());
  termios line{};
  REQUIRE(::tcgetattr(link->descriptor(), &line) == 0);
  CHECK(::cfgetospeed(&line) == B57600);
  CHECK((line.c_lflag & (ICANON | ECHO | ISIG)) == 0);
  CHECK((line.c_cflag & CRTSCTS) == 0);
  CHECK((line.c_cflag & CREAD) != 0);
}

TEST_CASE("bytes from before the link was opened are not heard") {
  const Device device;
  const int slave = ::open(device.name.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK);
  device.say("stale");
  const auto link = makeLink(device.link());
  device.say("fresh");
  CHECK(receive(*link, 5) == "fresh");
  ::close(slave);
}

TEST_CASE("an unplugged device is noticed and found again by name behind its symlink") {
  Device device;
  int64_t utime = 1'000'000;
  const auto link = makeLink(device.link());
  REQUIRE(link->isOpen());
  device.unplug();
  CHECK(noticesEnd(*link));
  CHECK_FALSE(link->isOpen());
  CHECK_FALSE(send(*link, "!G 1 0\r"));
  CHECK_FALSE(comesBack(*link, utime));
  CHECK_THAT(link->problem(), Catch::Contains("No such file or directory"));
  device.plugIn();
  utime += 1'000'000;
  REQUIRE(link->reopen(utime));
  CHECK(link->problem().empty());
  CHECK(send(*link, "!G 1 0\r"));
  CHECK(device.hear(7) == "!G 1 0\r");
}

TEST_CASE("a write to an unplugged device closes the link") {
  Device device;
  const auto link = makeLink(device.link());
  device.unplug();
  CHECK_FALSE(send(*link, "x"));
  CHECK_FALSE(link->isOpen());
}

TEST_CASE("a device that does not read never blocks, half a command ends with a hang-up") {
  const Device device;
  const auto link = makeLink(device.link());
  const std::string command = "!M -1000 -1000 and what makes it long and of odd size\r";
  size_t commands = 0;
  const auto start = std::chrono::steady_clock::now();
  while (commands < 100'000 && send(*link, command)) ++commands;
  CHECK(commands < 100'000);
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(1));
  // Bytes already in the terminal (at most 4095) cannot be recalled.
  size_t heard = 0;
  ssize_t count = 0;
  char buffer[4096];
  while ((count = ::read(device.master, buffer, sizeof buffer)) > 0)
    heard += static_cast<size_t>(count);
  CHECK(heard <= (commands + 1) * command.size());
  CHECK((heard % command.size() == 0 || (!link->isOpen() && count < 0 && errno == EIO)));
}

TEST_CASE("a second program is kept off the line, also after the first was killed") {
  const Device device;
  const int kept_by_emulator = ::open(device.name.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK);
  auto first = makeLink(device.link());
  const auto second = makeLink(device.link());
  REQUIRE(first->isOpen());
  CHECK_FALSE(second->isOpen());
  CHECK_THAT(second->problem(), Catch::Contains("in use by another program"));
  CHECK_NOTHROW(requireFree(*first));
  CHECK_THROWS_WITH(requireFree(*second),
                    device.link() +
                        ": in use by another program; stop that one, or name another "
                        "device in the configuration");
  first.reset();
  CHECK(second->reopen(1'000'000));
  ::close(kept_by_emulator);
}

TEST_CASE("a last command still leaves when the link is closed properly") {
  const Device device;
  auto link = makeLink(device.link());
  CHECK(send(*link, "!M 0 0\r"));
  link.reset();
  CHECK(device.hear(7) == "!M 0 0\r");
}

TEST_CASE("what is no terminal is refused") {
  const auto link = makeLink("tty:/dev/null");
  CHECK_FALSE(link->isOpen());
  CHECK(link->problem() == "tty:/dev/null: not a terminal; name a serial device");
}

}  // namespace tread
