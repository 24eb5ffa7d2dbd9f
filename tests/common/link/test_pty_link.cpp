// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <filesystem>
#include <fstream>

#include <catch2/catch.hpp>

#include "common/link/make_link.hpp"
#include "tests/common/link/link_helpers.hpp"

namespace tread {

using testing::comesBack;
using testing::receive;
using testing::send;
namespace fs = std::filesystem;

namespace {

/// A temporary folder.
struct Folder {
  Folder() { fs::remove_all(path); }
  ~Folder() { fs::remove_all(path); }
  std::string path = fs::temp_directory_path() / ("tread_pty_" + std::to_string(::getpid()));
};

}  // namespace

TEST_CASE("an emulated serial device is found by its name and carries every byte both ways") {
  const Folder folder;
  const auto device = makeLink("pty:" + folder.path + "/devices/ins");
  REQUIRE(device->isOpen());
  const auto robot = makeLink("tty:" + folder.path + "/devices/ins?baud=460800");
  REQUIRE(robot->isOpen());
  std::string all;
  for (int byte = 0; byte < 256; ++byte) all += static_cast<char>(byte);
  REQUIRE(send(*device, all));
  CHECK(receive(*robot, all.size()) == all);
  REQUIRE(send(*robot, all));
  CHECK(receive(*device, all.size()) == all);
}

TEST_CASE("a robot that comes, goes and comes again is no hang-up for the device") {
  const Folder folder;
  const auto device = makeLink("pty:" + folder.path + "/motor");
  for (int i = 0; i < 3; ++i) {
    const auto robot = makeLink("tty:" + folder.path + "/motor");
    REQUIRE(send(*robot, "!G 1 0\r"));
    CHECK(receive(*device, 7) == "!G 1 0\r");
  }
  uint8_t buffer[16];
  CHECK(device->read(buffer, sizeof buffer) == 0U);
}

TEST_CASE("bytes that nobody reads are lost without a hang-up, and are not heard later") {
  const Folder folder;
  const auto device = makeLink("pty:" + folder.path + "/ins");
  const std::string line(1000, 'x');
  int taken = 0;
  while (taken < 1000 && send(*device, line)) ++taken;
  CHECK(taken < 1000);
  CHECK(device->isOpen());
  const auto robot = makeLink("tty:" + folder.path + "/ins");
  REQUIRE(send(*device, "fresh"));
  CHECK(receive(*robot, 5) == "fresh");
}

TEST_CASE("a device that ends takes its name along, and the robot finds the next one") {
  const Folder folder;
  auto device = makeLink("pty:" + folder.path + "/ins");
  const auto robot = makeLink("tty:" + folder.path + "/ins");
  device.reset();
  CHECK_FALSE(fs::exists(fs::symlink_status(folder.path + "/ins")));
  CHECK(testing::noticesEnd(*robot));
  device = makeLink("pty:" + folder.path + "/ins");
  int64_t utime = 10'000'000;
  REQUIRE(comesBack(*robot, utime));
  REQUIRE(send(*device, "again"));
  CHECK(receive(*robot, 5) == "again");
}

TEST_CASE("a name that is a file of somebody is left alone") {
  const Folder folder;
  fs::create_directories(folder.path);
  std::ofstream(folder.path + "/ins") << "mine";
  const auto device = makeLink("pty:" + folder.path + "/ins");
  CHECK_FALSE(device->isOpen());
  CHECK_THAT(device->problem(), Catch::Contains("no link; remove it"));
  CHECK(fs::file_size(folder.path + "/ins") == 4);
}

}  // namespace tread
