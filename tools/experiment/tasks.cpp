// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

#include "tools/experiment/experiment.hpp"

namespace tread::experiment {
namespace {

/// Threads that take one task after the other.
class Crew {
 public:
  Crew(const std::vector<std::function<void()>>& tasks, const Progress& progress)
      : tasks_(tasks), progress_(progress) {}

  void run(int threads) {
    std::vector<std::thread> helpers;
    for (int i = 1; i < threads; ++i) helpers.emplace_back([this] { work(); });
    work();
    for (std::thread& helper : helpers) helper.join();
    if (error_) std::rethrow_exception(error_);
  }

 private:
  void work() {
    for (size_t i = next_++; i < tasks_.size(); i = next_++) {
      try {
        tasks_[i]();
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex_);
        if (!error_) error_ = std::current_exception();
        next_ = tasks_.size();
        return;
      }
      const std::lock_guard<std::mutex> lock(mutex_);
      ++done_;
      if (progress_) progress_(done_, tasks_.size());
    }
  }

  const std::vector<std::function<void()>>& tasks_;
  const Progress& progress_;
  std::atomic<size_t> next_{0};
  std::mutex mutex_;
  size_t done_ = 0;
  std::exception_ptr error_;
};

}  // namespace

void runTasks(const std::vector<std::function<void()>>& tasks, int threads,
              const Progress& progress) {
  Crew(tasks, progress).run(threads);
}

}  // namespace tread::experiment
