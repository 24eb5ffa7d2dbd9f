// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/core/controller_connection.hpp"

#include <algorithm>

#include "modules/motor_bridge/core/program.hpp"

namespace tread::motor {
namespace {

constexpr int64_t kLineSpan = 5'000'000;  // [us] over which a line is evaluated
constexpr int64_t kFewExchanges = 50;
constexpr int64_t kWorstPercent = 5;  // of exchanges that may fail on a sound line

}  // namespace

void ControllerConnection::open() {
  backoff_us_ = 0;
  enter(Phase::kStarting);
  ++counters_["link opened"];
}

void ControllerConnection::close(const std::string& problem) {
  counters_["link lost"] += isOpen();
  problem_ = problem;
  enter(Phase::kClosed);
}

void ControllerConnection::enter(Phase phase) {
  phase_ = phase;
  step_ = 0;
  tries_ = 0;
  if (phase == Phase::kReady) return;
  forget();
  output_.clear();
}

void ControllerConnection::fail(const std::string& problem, int64_t now,
                                const std::string& detail) {
  problem_ = problem + detail;
  ++counters_["controller lost: " + problem];
  backoff_us_ = std::clamp(2 * backoff_us_, times_.backoff_min_us, times_.backoff_max_us);
  retry_at_ = now + backoff_us_;
  enter(Phase::kBackoff);
  // Perhaps only its answers are lost: stop it at once instead of waiting for its watchdog.
  sendZero(now);
}

void ControllerConnection::sendZero(int64_t now) {
  output_ += zero();
  zero_at_ = now;
}

std::string ControllerConnection::zeros(int times) const {
  std::string bytes;
  for (int i = 0; i < times; ++i) bytes += zero();
  return bytes;
}

void ControllerConnection::command(const Command& command, int64_t now) {
  if (!ready()) return;
  // A fifth before the watchdog expires, because transmission takes time, too.
  const bool silent = 5 * (now - commanded_at_) > 4 * times_.watchdog_us;
  if (silent && !isZero(command)) ++counters_["zero before resuming"];
  commanded_at_ = now;
  give(silent ? Command{} : command, now);
}

std::string ControllerConnection::poll(int64_t now) {
  if (phase_ == Phase::kBackoff && now >= retry_at_) enter(Phase::kStarting);
  if (phase_ == Phase::kReady) {
    output_ += talk(now);
    watchLine(now);
    const std::string problem = lost(now);
    if (!problem.empty()) fail(problem, now);
  } else if (phase_ == Phase::kBackoff && now - zero_at_ >= times_.stop_interval_us) {
    sendZero(now);
  } else if (phase_ == Phase::kStarting) {
    pollStartup(now);
  }
  std::string output;
  output.swap(output_);
  return output;
}

void ControllerConnection::pollStartup(int64_t now) {
  if (tries_ > 0 && now - asked_at_ < times_.reply_timeout_us) return;
  if (tries_ == times_.startup_tries) {
    fail("no good answer to " + startupName(step_), now);
    return;
  }
  ++tries_;
  asked_at_ = now;
  output_ += startupRequest(step_);
  if (!isAnswered(step_)) stepDone(now);
}

void ControllerConnection::stepRefused(int64_t now) {
  ++counters_["start-up requests refused"];
  asked_at_ = now - times_.reply_timeout_us;
}

void ControllerConnection::stepDone(int64_t now) {
  ++step_;
  tries_ = 0;
  if (step_ < startupSteps()) {
    pollStartup(now);
    return;
  }
  enter(Phase::kReady);
  backoff_us_ = 0;
  commanded_at_ = now;
  ++counters_["start-ups"];
  begin(now);
}

ControllerConnection::Exchanges ControllerConnection::exchanges(int64_t now) const {
  Exchanges sum{now, 0, 0};
  for (const auto& [name, count] : counted()) {
    if (name == "commands sent" || name == "queries sent") sum.all += count;
    for (const char* failure : {"replies missing", "commands refused", "queries refused"})
      if (name == failure) sum.failed += count;
  }
  return sum;
}

void ControllerConnection::watchLine(int64_t now) {
  if (!line_.empty() && now - line_.back().utime < kLineSpan / 10) return;
  line_.push_back(exchanges(now));
  while (line_.size() > 2 && now - line_.front().utime > kLineSpan) line_.pop_front();
}

std::string ControllerConnection::lineProblem() const {
  if (line_.empty() || !ready()) return "";
  const int64_t all = line_.back().all - line_.front().all;
  const int64_t failed = line_.back().failed - line_.front().failed;
  if (all < kFewExchanges || 100 * failed < kWorstPercent * all) return "";
  return std::to_string(100 * failed / all) + " % of the exchanges with the controller failed in " +
         "the last " + std::to_string(kLineSpan / 1'000'000) +
         " s; check cable, plugs and earthing";
}

DeviceReport ControllerConnection::report(int64_t now) const {
  DeviceReport report;
  if (ready()) return reported(now);
  report.link_fault = "controller lost: " + problem_;
  if (phase_ == Phase::kStarting) {
    report.link_code = StopReason::kControllerStarts;
    report.link_fault = sentenceOf(report.link_code);
  }
  return report;
}

std::map<std::string, int64_t> ControllerConnection::counters() const {
  std::map<std::string, int64_t> counters = counters_;
  for (const auto& [name, count] : counted()) counters[name] += count;
  return counters;
}

}  // namespace tread::motor
