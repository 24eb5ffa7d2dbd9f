// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/patterns/live_run.hpp"

#include <atomic>
#include <csignal>
#include <iostream>
#include <stdexcept>

#include "common/bus/lcm_bus.hpp"
#include "common/recordings/recordings.hpp"
#include "common/recordings/text_file.hpp"

namespace tread::patterns {
namespace {

// A signal handler can reach nothing but a global; it lives in this file only.
std::atomic<bool> g_stop{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void noteSignal(int /*signal*/) {
  g_stop = true;
}

/// The recorder, ending its own run once it is done or has failed.
class RunToItsEnd : public Node {
 public:
  explicit RunToItsEnd(pattern_recorder::RecorderNode& recorder) : recorder_(recorder) {}

  int64_t period() const override { return recorder_.period(); }
  void step(int64_t utime) override {
    recorder_.step(utime);
    if (recorder_.state() != pattern_recorder::RecorderNode::State::kRunning) g_stop = true;
  }
  void shutdown(int64_t utime) override { recorder_.shutdown(utime); }

 private:
  pattern_recorder::RecorderNode& recorder_;
};

/// Where the part was written, in words; empty if there was nothing to write.
std::string keepPart(const std::string& path, const PatternSet& set,
                     const pattern_recorder::RecorderNode& recorder) {
  size_t executions = 0;
  for (const auto& of_pattern : recorder.recorded()) executions += of_pattern.size();
  if (executions == 0) return "";
  recordings::writeText(path, recordings::formatSurface({"", recorder.recorded()}, set));
  return "; the " + std::to_string(executions) + " executions until then are in " + path;
}

}  // namespace

std::vector<std::vector<recordings::Execution>> recordLive(
    const PatternSet& set, const pattern_recorder::RecordingConfig& how, const std::string& lcm_url,
    const std::string& part) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, noteSignal);
  LcmBus bus(lcm_url, TimeSource::kFollow);
  pattern_recorder::RecorderNode recorder(
      set, how, bus, [](const std::string& line) { std::cout << line << std::endl; });
  RunToItsEnd node(recorder);
  bus.run(node, g_stop);
  if (recorder.state() == pattern_recorder::RecorderNode::State::kDone) return recorder.recorded();
  const bool failed = recorder.state() == pattern_recorder::RecorderNode::State::kFailed;
  throw std::runtime_error((failed ? recorder.reason() : "interrupted, the robot was stopped") +
                           keepPart(part, set, recorder));
}

}  // namespace tread::patterns
