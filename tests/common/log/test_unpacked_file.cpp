// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <zlib.h>

#include "common/log/unpacked_file.hpp"
#include "tests/common/log/log_helpers.hpp"

using namespace tread;
using namespace tread::testing;

namespace {

void pack(const std::string& path, const std::string& content) {
  gzFile file = gzopen(path.c_str(), "wb");
  REQUIRE(gzwrite(file, content.data(), static_cast<unsigned>(content.size())) ==
          static_cast<int>(content.size()));
  REQUIRE(gzclose(file) == Z_OK);
}

std::string numbers() {
  std::string text;
  for (int i = 0; i < 100'000; ++i) text += std::to_string(i) + "\n";
  return text;
}

}  // namespace

TEST_CASE("a file that gzip packed is read as what it was, and named by its own name") {
  const TemporaryFile packed;
  pack(packed.path, numbers());
  const UnpackedFile file(packed.path);
  CHECK(file.problem().empty());
  CHECK(file.path() != packed.path);
  CHECK(contentOf(file.path()) == numbers());
  CHECK(file.named(file.path() + ":3: no number; see " + file.path()) ==
        packed.path + ":3: no number; see " + packed.path);
}

TEST_CASE("a packed file that was cut off gives what is whole, and says so") {
  const TemporaryFile packed;
  pack(packed.path, numbers());
  const std::string whole = contentOf(packed.path);
  makeFile(packed.path, whole.substr(0, whole.size() / 2));
  const UnpackedFile file(packed.path);
  CHECK_THAT(file.problem(), Catch::Contains("damaged or cut off"));
  const std::string text = contentOf(file.path());
  CHECK(text.size() > 10'000);
  CHECK(numbers().rfind(text, 0) == 0);
  CHECK_THAT(file.reasonOf(file.path() + ":3: no number"),
             Catch::StartsWith(packed.path + ": the gzip data is damaged or cut off") &&
                 Catch::Contains(packed.path + ":3: no number"));
}

TEST_CASE("a plain file is read where it is, other packers are named with what unpacks them") {
  const TemporaryFile plain;
  makeFile(plain.path, "t,x\n1,2\n");
  CHECK(UnpackedFile(plain.path).path() == plain.path);
  CHECK(UnpackedFile("/nowhere/drive.csv").path() == "/nowhere/drive.csv");
  for (const auto& [magic, command] : {std::pair<std::string, std::string>("\xfd"
                                                                           "7zXZ",
                                                                           "xz -dk "),
                                       {"BZh91AY", "bzip2 -dk "},
                                       {"\x28\xb5\x2f\xfd", "zstd -dk "},
                                       {"PK\x03\x04", "unzip "}}) {
    makeFile(plain.path, magic + "some bytes");
    CHECK_THROWS_WITH(UnpackedFile(plain.path), Catch::Contains(command + plain.path));
  }
}
