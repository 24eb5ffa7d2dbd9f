// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/missions/campaigner.hpp"

#include <atomic>
#include <chrono>
#include <iostream>
#include <mutex>
#include <thread>

namespace tread::missions {
namespace {

/// The threads that share the missions of one order.
class Campaigner {
 public:
  Campaigner(const RobotConfig& robot, const CampaignOrder& order) : robot_(robot), order_(order) {}

  Campaign run() {
    campaign_.seed = order_.seed;
    campaign_.rule = order_.name;
    campaign_.overrides = order_.overrides;
    campaign_.results.resize(static_cast<size_t>(order_.missions));
    const auto started = std::chrono::steady_clock::now();
    std::vector<std::thread> threads;
    for (int i = 0; i < order_.threads; ++i) threads.emplace_back([this] { work(); });
    for (std::thread& thread : threads) thread.join();
    if (error_) std::rethrow_exception(error_);
    campaign_.wall_time =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    return std::move(campaign_);
  }

 private:
  void work() {
    try {
      for (int i = next_++; i < order_.missions; i = next_++) {
        MissionRun run = drive(order_.seed + static_cast<uint64_t>(i));
        const std::lock_guard<std::mutex> lock(mutex_);
        campaign_.virtual_time += run.virtual_time;
        campaign_.cpu_time += run.cpu_time;
        std::cout << lineOf(run.result) << '\n' << crossingsOf(run.result) << std::flush;
        campaign_.results[static_cast<size_t>(i)] = std::move(run.result);
      }
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex_);
      error_ = std::current_exception();
      next_ = order_.missions;
    }
  }

  MissionRun drive(uint64_t seed) {
    MissionOptions options = order_.options;
    std::optional<LogWriter> log;
    if (!order_.log.empty() && seed == order_.seed) options.log = &log.emplace(order_.log);
    MissionRun run = runMission(robot_, seed, options);
    if (log) log->flush();
    if (order_.show == seed) {
      report::drawDrive(order_.picture, driveSceneOf(run.result, run.scene));
      const std::lock_guard<std::mutex> lock(mutex_);
      std::cout << "picture: " << order_.picture << std::endl;
    }
    return run;
  }

  const RobotConfig& robot_;
  const CampaignOrder& order_;
  Campaign campaign_;
  std::atomic<int> next_{0};
  std::mutex mutex_;
  std::exception_ptr error_;
};

}  // namespace

Campaign runCampaign(const RobotConfig& robot, const CampaignOrder& order) {
  return Campaigner(robot, order).run();
}

}  // namespace tread::missions
