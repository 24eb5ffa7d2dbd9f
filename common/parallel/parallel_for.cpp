// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/parallel/parallel_for.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace tread {

ParallelFor onThreads(int threads) {
  return [threads](size_t count, const std::function<void(size_t)>& body) {
    const size_t workers = std::min(count, static_cast<size_t>(std::max(1, threads)));
    std::atomic<size_t> next{0};
    std::mutex mutex;  // guards the error
    std::exception_ptr error;
    const auto work = [&] {
      try {
        for (size_t i = next++; i < count; i = next++) body(i);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex);
        if (!error) error = std::current_exception();
        next = count;
      }
    };
    std::vector<std::thread> helpers;
    try {
      for (size_t i = 1; i < workers; ++i) helpers.emplace_back(work);
    } catch (const std::system_error&) {
      // If no more threads can be created, the running ones do all the work.
    }
    work();
    for (std::thread& helper : helpers) helper.join();
    if (error) std::rethrow_exception(error);
  };
}

}  // namespace tread
