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
