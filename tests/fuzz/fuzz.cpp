// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// libFuzzer's entry: TREAD_FUZZ names the target.
#include <cstdio>
#include <cstdlib>

#include "tests/fuzz/targets.hpp"

namespace {

tread::fuzz::Target chosen() {
  const char* name = std::getenv("TREAD_FUZZ");
  const auto& targets = tread::fuzz::targets();
  const auto found = targets.find(name == nullptr ? "" : name);
  if (found != targets.end()) return found->second;
  std::fprintf(stderr, "set TREAD_FUZZ to one of:");
  for (const auto& [known, target] : targets) std::fprintf(stderr, " %s", known.c_str());
  std::fprintf(stderr, "\n");
  std::exit(2);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  static const tread::fuzz::Target target = chosen();
  target(bytes, size);
  return 0;
}
