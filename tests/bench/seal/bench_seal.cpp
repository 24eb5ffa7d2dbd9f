// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "common/seal/seal.hpp"

namespace {

using namespace tread;

/// One iteration: a message is sealed by its sender and opened by one receiver.
void sealAndOpen(benchmark::State& state) {
  const SealKey key;
  Sealer sender(key, 1, 3);
  Sealer receiver(key, 2, 3);
  const auto size = static_cast<size_t>(state.range(0));
  std::vector<uint8_t> bytes(size + kSealBytes);
  int64_t utime = 0;
  for (auto _ : state) {
    bytes.resize(size);
    utime += 20'000;
    sender.seal("PROGRAM", bytes, utime);
    const OpenedSeal opened = receiver.open("PROGRAM", bytes.data(), bytes.size(), utime);
    if (opened.verdict != SealVerdict::kGood) std::abort();
    benchmark::DoNotOptimize(opened);
  }
}
BENCHMARK(sealAndOpen)->Arg(200)->Arg(1'000)->Arg(20'000)->Arg(60'000);

}  // namespace

BENCHMARK_MAIN();
