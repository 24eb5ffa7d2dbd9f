// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "tools/robot/view/admission.hpp"

using namespace tread::view;

TEST_CASE("without a token only this machine looks, by its name, and only pages from here") {
  const ServerSettings settings;
  for (const char* host :
       {"127.0.0.1:8765", "localhost:8765", "[::1]:8765", "localhost", "[::1]"}) {
    CAPTURE(host);
    CHECK(mayLook({host, "", ""}, settings));
    CHECK(mayLook({host, std::string("http://") + host, ""}, settings));
    for (const char* origin : {"http://evil.example", "null", "file://", "http://127.0.0.1:1",
                               "http://127.0.0.1:8765.evil.example", "https://app.foxglove.dev"})
      CHECK_FALSE(mayLook({host, origin, ""}, settings));
  }
  for (const char* host : {"", ":", "[", "evil.example", "127.0.0.1.evil.example", "localhost.evil",
                           "evil.example:8765", "[::1].evil", "0.0.0.0:8765"}) {
    CAPTURE(host);
    CHECK_FALSE(mayLook({host, "", ""}, settings));
    CHECK_FALSE(mayLook({host, std::string("http://") + host, ""}, settings));
  }
}

TEST_CASE("who has the token looks from everywhere, and operates only from our own page") {
  ServerSettings settings;
  settings.token = "secret";
  const Visitor foreign{"robot:8765", "https://app.foxglove.dev", "secret"};
  CHECK(mayLook(foreign, settings));
  CHECK_FALSE(isOurs(foreign, settings));
  CHECK(isOurs({"robot:8765", "https://robot:8765", "secret"}, settings));
  for (const char* token : {"", "secre", "secretsecret", "Secret"})
    CHECK_FALSE(mayLook({"127.0.0.1:8765", "", token}, settings));
}

TEST_CASE("an origin that is named is ours, as browsers write it, under its path") {
  ServerSettings settings;
  REQUIRE(addOrigin("https://Ops.Example:443/robot/", settings).empty());
  REQUIRE(addOrigin("http://ops.example:8080", settings).empty());
  REQUIRE(addOrigin("https://plain.example/", settings).empty());
  CHECK(settings.origins == std::vector<std::string>{"https://ops.example",
                                                     "http://ops.example:8080",
                                                     "https://plain.example"});
  CHECK(settings.paths == std::set<std::string>{"/robot/"});
  CHECK(isOurs({"127.0.0.1:8765", "https://ops.example", ""}, settings));
  CHECK_FALSE(isOurs({"127.0.0.1:8765", "http://ops.example", ""}, settings));
  CHECK_FALSE(isOurs({"127.0.0.1:8765", "https://ops.example.evil", ""}, settings));
  for (const char* wrong : {"robot.example", "ftp://robot.example", "https://", "https:///x",
                            "https://a/?token=b", "https://user@a/", ""})
    CHECK_FALSE(addOrigin(wrong, settings).empty());
}
