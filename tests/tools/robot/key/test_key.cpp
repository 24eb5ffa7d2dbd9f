// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <algorithm>

#include "tests/tools/called_program.hpp"

using tread::samples::called;
using tread::samples::OwnFolder;

TEST_CASE("tread-key makes a key once, checks it and tells its fingerprint, never the key") {
  const OwnFolder folder;
  const std::string path = folder.path("key");
  const auto made = called("tread-key new " + path);
  CHECK(made.status == 0);
  CHECK(made.says(path + ": made, fingerprint "));
  const std::string text = folder.text("key");
  const std::string digits = text.substr(text.find('\n') + 1, 64);
  const auto again = called("tread-key new " + path);
  CHECK(again.status == 2);
  CHECK(again.isOneLine());
  CHECK(again.says("tread-key: key " + path + ": cannot be made (File exists)"));
  CHECK(folder.text("key") == text);
  const auto shown = called("tread-key show " + path);
  CHECK(shown.status == 0);
  CHECK(shown.isOneLine());
  CHECK(made.says(shown.printed));
  CHECK(shown.printed.size() == 20);
  std::string fingerprint = shown.printed.substr(0, 19);
  fingerprint.erase(std::remove(fingerprint.begin(), fingerprint.end(), '-'), fingerprint.end());
  CHECK(digits.find(fingerprint) == std::string::npos);
  CHECK(called("tread-key check " + path).says(path + ": good, fingerprint "));
  std::filesystem::permissions(path, std::filesystem::perms(0604));
  for (const char* command : {"check ", "show "}) {
    const auto open = called("tread-key " + (command + path));
    CHECK(open.status == 2);
    CHECK(open.isOneLine());
    CHECK(open.says("mode 0604"));
  }
}

TEST_CASE("an operator's command with a key that is none sends nothing, and says so in one line") {
  const OwnFolder folder;
  const std::string path = folder.write("key", "secret\n");
  std::filesystem::permissions(path, std::filesystem::perms(0600));
  for (const char* command : {"tread-arm", "tread-stop", "tread-goal 1 2"}) {
    const auto refused = called(std::string(command) + " --lcm-url memq:// --key " + path);
    CAPTURE(command, refused.printed);
    CHECK(refused.status == 1);
    CHECK(refused.isOneLine());
    CHECK(refused.says("holds no key"));
    CHECK(called(std::string(command) + " --key ''").status == 2);
  }
}

TEST_CASE("a TREAD_KEY that names no file starts nothing without a key") {
  setenv("TREAD_KEY", "", 1);
  for (const char* command : {"tread-arm --lcm-url memq://", "tread-mapping --check"}) {
    const auto refused = called(command);
    CAPTURE(command, refused.printed);
    CHECK(refused.status == 2);
    CHECK(refused.isOneLine());
    CHECK(refused.says("TREAD_KEY"));
  }
  // Stopping needs no key.
  CHECK(called("tread-stop --lcm-url memq:// --timeout 1").says("NOBODY CONFIRMS THE STOP"));
  unsetenv("TREAD_KEY");
}

TEST_CASE("what moves the robot as long as it runs warns where it was started over ssh") {
  setenv("SSH_CONNECTION", "192.0.2.1 50000 192.0.2.2 22", 1);
  const auto warned = called("tread-goal 1 2 --lcm-url memq:// --timeout 1");
  CHECK(warned.says("does not notice when that connection is lost"));
  CHECK_FALSE(called("tread-stop --lcm-url memq:// --timeout 1").says("over ssh"));
  unsetenv("SSH_CONNECTION");
}
