// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>

#include "tests/tools/called_program.hpp"
#include "tools/robot/view/certificate.hpp"

using namespace tread::view;
using tread::samples::OwnFolder;
namespace fs = std::filesystem;

TEST_CASE("a machine makes its certificate once, for itself alone, and no two make the same") {
  const OwnFolder folder;
  const Certificate first = ownCertificate(folder.path("view"));
  CHECK(first.made);
  CHECK(first.fingerprint.size() == 95);
  CHECK((fs::status(first.path).permissions() & fs::perms::mask) ==
        (fs::perms::owner_read | fs::perms::owner_write));
  const Certificate again = ownCertificate(folder.path("view"));
  CHECK_FALSE(again.made);
  CHECK(again.fingerprint == first.fingerprint);
  CHECK(ownCertificate(folder.path("other")).fingerprint != first.fingerprint);
}

TEST_CASE("a certificate that others may read, or that is none, is refused with the remedy") {
  const OwnFolder folder;
  const std::string path = ownCertificate(folder.path("view")).path;
  fs::permissions(path, fs::perms(0644));
  CHECK_THROWS_WITH(ownCertificate(folder.path("view")),
                    Catch::Contains("certificate " + path + ": others than its owner") &&
                        Catch::Contains("chmod 600"));
  fs::permissions(path, fs::perms(0600));
  const std::string whole = folder.text("view/certificate.pem");
  for (const std::string& text : {std::string(), std::string("nothing"),
                                  whole.substr(0, whole.find("-----BEGIN PRIVATE KEY"))}) {
    CAPTURE(text);
    std::ofstream(path, std::ios::trunc) << text;
    CHECK_THROWS_WITH(ownCertificate(folder.path("view")),
                      Catch::Contains("does not contain a certificate and its key; remove it"));
  }
  CHECK_THROWS_WITH(ownCertificate("/proc/none"), Catch::Contains("cannot be made"));
}
