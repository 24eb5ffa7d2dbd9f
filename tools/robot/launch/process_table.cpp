// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/launch/process_table.hpp"

#include <algorithm>
#include <csignal>
#include <cstring>
#include <utility>

#include <sys/wait.h>

#include "common/report/text.hpp"

namespace tread::launch {
namespace {

constexpr double kStable = 1.0;         // [s] after which a start counts as successful
constexpr double kLongestPause = 60.0;  // [s]

std::string howItEnded(int status) {
  if (!WIFSIGNALED(status)) return "exit status " + std::to_string(WEXITSTATUS(status));
  const char* const name = sigabbrev_np(WTERMSIG(status));
  return "terminated by SIG" + (name != nullptr ? name : std::to_string(WTERMSIG(status)));
}

}  // namespace

ProcessTable::ProcessTable(std::string launch, std::vector<LaunchProcess> processes)
    : launch_(std::move(launch)) {
  for (LaunchProcess& process : processes) {
    entries_.emplace_back();
    entries_.back().process = std::move(process);
  }
}

bool ProcessTable::lives(const Entry& entry) const {
  return entry.state == Entry::kStarting || entry.state == Entry::kRuns ||
         entry.state == Entry::kStopping;
}

std::vector<ProcessTable::Task> ProcessTable::due(double now) {
  if (!start_) start_ = now;
  if (stopping_) return dueToStop(now);
  std::vector<Task> tasks;
  for (size_t i = 0; i < entries_.size(); ++i) {
    Entry& entry = entries_[i];
    if (entry.state == Entry::kStarting && now - entry.since >= kStable) nowRuns(entry, now);
    if (entry.state == Entry::kWaits && now >= entry.since) tasks.push_back({Task::kStart, i, 0});
  }
  return tasks;
}

/// One at a time, so that a process that depends on another still has it.
std::vector<ProcessTable::Task> ProcessTable::dueToStop(double now) {
  for (Entry& entry : entries_)
    if (!lives(entry)) entry.state = Entry::kStopped;
  const auto last = std::find_if(entries_.rbegin(), entries_.rend(),
                                 [this](const Entry& entry) { return lives(entry); });
  if (last == entries_.rend()) return {};
  const auto place = static_cast<size_t>(entries_.rend() - last) - 1;
  if (last->state != Entry::kStopping) {
    last->state = Entry::kStopping;
    last->since = now;
    return {{Task::kAskToEnd, place, last->pid}};
  }
  if (last->killed || now - last->since < static_cast<double>(last->process.stop_time)) return {};
  last->killed = true;
  const std::string& name = last->process.name;
  note("killing '" + name + "' (" + std::to_string(last->pid) + ") with SIGKILL",
       launch_ + ": " + name + " did not stop in time and is killed");
  return {{Task::kKill, place, last->pid}};
}

void ProcessTable::started(size_t process, std::optional<int> pid, double now) {
  Entry& entry = entries_.at(process);
  if (!pid) return restartLater(entry, "not started: no further process is possible", now);
  entry.state = Entry::kStarting;
  entry.pid = *pid;
  entry.since = now;
  note("spawned: '" + entry.process.name + "' with pid " + std::to_string(*pid));
}

std::optional<size_t> ProcessTable::ended(int pid, int status, double now) {
  for (size_t i = 0; i < entries_.size(); ++i) {
    Entry& entry = entries_[i];
    if (!lives(entry) || entry.pid != pid) continue;
    const std::string how = howItEnded(status);
    if (entry.state == Entry::kStopping) {
      note("stopped: " + entry.process.name + " (" + how + ")");
      entry.state = Entry::kStopped;
    } else {
      restartLater(entry, how + "; not expected", now);
    }
    return i;
  }
  return std::nullopt;
}

void ProcessTable::restartLater(Entry& entry, const std::string& how, double now) {
  const bool ran = entry.state == Entry::kRuns ||
                   (entry.state == Entry::kStarting && now - entry.since >= kStable);
  const std::string& name = entry.process.name;
  const std::string start = launch_ + ": " + name;
  ++entry.ends;
  note("exited: " + name + " (" + how + ")",
       entry.ends == 1   ? start + " ended (" + how + ")"
       : entry.ends == 2 ? start + " ended again (" + how +
                               "); the pauses between its starts grow, see log/" + name + ".log"
                         : "");
  entry.since = now + (ran ? 0.0 : std::min<double>(entry.ends, kLongestPause));
  entry.state = Entry::kWaits;
}

void ProcessTable::nowRuns(Entry& entry, double now) {
  entry.state = Entry::kRuns;
  const bool back = std::exchange(entry.ends, 0) > 0;
  const bool first = !std::exchange(entry.ran, true);
  const std::string& name = entry.process.name;
  std::string told = back ? launch_ + ": " + name + " runs again" : "";
  if (first && std::all_of(entries_.begin(), entries_.end(), [](const Entry& e) { return e.ran; }))
    told = formatted("%s: all %zu processes run after %.1f s", launch_.c_str(), entries_.size(),
                     now - *start_);
  note("success: " + name + " has run for 1 s", told);
}

bool ProcessTable::done() const {
  return stopping_ && std::all_of(entries_.begin(), entries_.end(),
                                  [this](const Entry& entry) { return !lives(entry); });
}

void ProcessTable::note(std::string log, const std::string& told) {
  events_.push_back({std::move(log), told});
}

std::vector<ProcessTable::Event> ProcessTable::takeEvents() {
  return std::exchange(events_, {});
}

std::string ProcessTable::status() const {
  static constexpr const char* kWords[] = {"BACKOFF", "STARTING", "RUNNING", "STOPPING", "STOPPED"};
  std::string lines;
  for (const Entry& entry : entries_) {
    lines += formatted("%-24s %-9s", entry.process.name.c_str(), kWords[entry.state]);
    if (lives(entry)) lines += " pid " + std::to_string(entry.pid);
    lines += "\n";
  }
  return lines;
}

}  // namespace tread::launch
