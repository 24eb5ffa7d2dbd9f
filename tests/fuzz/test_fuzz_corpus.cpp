// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <filesystem>

#include "tests/fuzz/targets.hpp"
#include "tests/helpers.hpp"

TEST_CASE("every input that a fuzzer has found is read or refused, and ends nothing") {
  const std::filesystem::path corpus = std::string(TREAD_SOURCE_DIR) + "/tests/data/fuzz";
  for (const auto& [name, target] : tread::fuzz::targets()) {
    CAPTURE(name);
    int played = 0;
    for (const auto& file : std::filesystem::directory_iterator(corpus / name)) {
      const std::string bytes = tread::testing::contentOf(file.path());
      target(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
      // Also what ends early.
      for (const size_t part : {bytes.size() / 2, bytes.size() / 3, size_t{0}})
        target(reinterpret_cast<const uint8_t*>(bytes.data()), part);
      ++played;
    }
    CHECK(played > 0);
  }
}
