// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <tread/health_t.hpp>
#include <tread/motor_t.hpp>
#include <tread/plan_t.hpp>

namespace tread::top {

/// Severity of a line.
enum class Mood { kTitle, kPlain, kGood, kDoubt, kBad };

struct Line {
  Mood mood = Mood::kPlain;
  std::string text;
};

/// Datagrams that the host's kernel has dropped since boot.
struct KernelCounters {
  int64_t buffer_errors = 0;  ///< dropped because a receive buffer was full
};
/// Parsed from /proc/net/snmp; nullopt if it has no UDP lines.
std::optional<KernelCounters> kernelCounters(const std::string& snmp);

/// Watches the bus: rates against the table, ages, sizes, losses, processes.
class Monitor {
 public:
  /// Counts a message, without its seal, received at host time `utime` [us].
  void take(const std::string& channel, const uint8_t* bytes, size_t size, int64_t now);
  void take(const KernelCounters& counters);
  /// A caveat about the displayed data; empty = none.
  void setDoubt(const std::string& words) { doubt_ = words; }

  /// The lines to show at a time [us]: channels in the order of the table, then unknown ones.
  std::vector<Line> lines(int64_t now) const;

 private:
  static constexpr int64_t kWindow = 3'000'000;  ///< [us] over which rates are counted
  /// Senders can invent names, so only so many are listed.
  static constexpr size_t kMostNames = 64;

  struct Stream {
    std::deque<std::pair<int64_t, size_t>> recent;  ///< [us], [bytes]
    int64_t last = 0;                               ///< [us]
    size_t largest = 0;                             ///< [bytes]
    int64_t messages = 0;
    int64_t lost = 0;
    int64_t broken = 0;
    std::map<uint64_t, int64_t> numbers;  ///< newest seq by sender
  };
  struct Process {
    int64_t heard = 0;  ///< [us]
    health_t health;
  };

  void count(Stream& stream, const std::string& channel, const std::vector<uint8_t>& bytes);
  Line lineOf(const std::string& channel, const Stream& stream, int64_t now) const;
  Line lineOf(const Process& process, int64_t now) const;

  std::map<std::string, Stream> streams_;
  std::map<std::string, Process> processes_;
  std::optional<motor_t> motor_;
  std::optional<plan_t> plan_;
  std::optional<KernelCounters> kernel_begun_, kernel_;
  std::string doubt_;
  int64_t begun_ = 0;  ///< [us] the first message
};

}  // namespace tread::top
