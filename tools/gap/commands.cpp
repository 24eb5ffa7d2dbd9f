// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/commands.hpp"

#include <algorithm>
#include <thread>

namespace tread::gap {

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
