// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/commands.hpp"

#include <algorithm>
#include <thread>
#include <vector>

namespace tread::gap {

ParallelFor onThreads(int threads) {
  return [threads](size_t count, const std::function<void(size_t)>& body) {
    const size_t workers = std::min(count, static_cast<size_t>(std::max(1, threads)));
    if (workers <= 1) return serialFor(count, body);
    std::vector<std::thread> pool;
    for (size_t w = 0; w < workers; ++w)
      pool.emplace_back([&, w] {
        for (size_t i = w; i < count; i += workers) body(i);
      });
    for (std::thread& worker : pool) worker.join();
  };
}

void addSeedAndThreads(CLI::App& command, int64_t& seed, int& threads) {
  threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  command.add_option("--seed", seed, "of the random draws of the tests")
      ->capture_default_str()
      ->check(CLI::Range(int64_t{0}, int64_t{9'000'000'000'000'000'000}));
  command.add_option("--threads", threads, "no influence on any byte")
      ->capture_default_str()
      ->check(CLI::Range(1, 1024));
}

}  // namespace tread::gap
