// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The bytes of each type since its last intended change: a change of a .lcm file that breaks old
// logs fails here. After an intended change remake them with
//     TREAD_REMAKE_GOLDEN=1 build/release/tests/test_lcmtypes "golden*"
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <catch2/catch.hpp>

#include "tests/helpers.hpp"
#include "type_samples.hpp"

namespace tread {
namespace {

/// 32 bytes per line, as hexadecimal numbers.
std::string hexOf(const std::vector<uint8_t>& bytes) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string text;
  for (size_t i = 0; i < bytes.size(); ++i) {
    text += kDigits[bytes[i] >> 4];
    text += kDigits[bytes[i] & 0xF];
    if (i % 32 == 31 || i + 1 == bytes.size()) text += '\n';
  }
  return text;
}

using tread::testing::contentOf;

}  // namespace

TEST_CASE("golden bytes: each type is encoded as it always was") {
  const std::string folder = std::string(TREAD_SOURCE_DIR) + "/tests/data/golden";
  const bool remake = std::getenv("TREAD_REMAKE_GOLDEN") != nullptr;
  if (remake) std::filesystem::create_directories(folder);
  size_t types = 0;
  testing::forEachType([&](const auto& sample) {
    const std::string path = folder + "/" + std::decay_t<decltype(sample)>::getTypeName() + ".hex";
    const std::string bytes = hexOf(testing::encode(sample));
    if (remake) std::ofstream(path) << bytes;
    INFO(path);
    CHECK(contentOf(path) == bytes);
    ++types;
  });
  const auto files = std::distance(std::filesystem::directory_iterator(folder),
                                   std::filesystem::directory_iterator());
  CHECK(static_cast<size_t>(files) == types);
}

}  // namespace tread
