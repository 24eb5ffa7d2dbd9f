// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/launch/liveness.hpp"

#include "common/report/text.hpp"

namespace tread::launch {
namespace {

constexpr double kAbortTime = 1.0;  // s from SIGABRT to SIGKILL

bool contains(const std::string& text, const char* part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

Liveness::Liveness(const std::vector<LaunchProcess>& processes) {
  for (const LaunchProcess& process : processes)
    if (!process.external) processes_[process.name] = process;
}

void Liveness::started(const std::string& process, int pid) {
  if (processes_.count(process) > 0) running_[process] = {pid};
}

void Liveness::hear(int pid, const std::string& lines) {
  for (auto& [name, watched] : running_) {
    if (watched.pid != pid) continue;
    watched.silence = 0.0;
    // READY=1 may have been lost, but a heartbeat implies it.
    watched.ready |= contains(lines, "READY=1") || contains(lines, "WATCHDOG=1");
    watched.stopping |= contains(lines, "STOPPING=1");
  }
}

std::vector<Liveness::Hung> Liveness::pass(double seconds) {
  std::vector<Hung> hung;
  for (auto& [name, watched] : running_) {
    watched.silence += seconds;
    for (Hung& one : judge(name, watched)) hung.push_back(std::move(one));
  }
  return hung;
}

std::vector<Liveness::Hung> Liveness::judge(const std::string& name, Watched& watched) const {
  const LaunchProcess& process = processes_.at(name);
  if (watched.aborted) {
    if (watched.silence < kAbortTime) return {};
    watched.silence = 0.0;
    return {{name, watched.pid, true, name + " does not end and is killed"}};
  }
  // Without a watchdog a process may be silent, but a stop must still complete in time.
  if (process.watchdog == 0.0 && !watched.stopping) return {};
  const double limit = watched.stopping ? static_cast<double>(process.stop_time)
                       : watched.ready  ? process.watchdog
                                        : process.start_time;
  if (watched.silence < limit) return {};
  const std::string what = watched.stopping ? " has not ended within "
                           : watched.ready  ? " hangs: no sign of life for "
                                            : " has not become ready within ";
  watched.silence = 0.0;
  watched.aborted = true;
  return {{name, watched.pid, false, name + what + formatted("%.1f s", limit) + "; it is aborted"}};
}

}  // namespace tread::launch
