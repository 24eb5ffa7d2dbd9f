// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "modules/ins_driver/core/ins_assembler.hpp"
#include "modules/ins_driver/core/ins_source.hpp"

namespace tread::ins {

/// Monitors the rate of each input of a pose: a heading once a second with positions at 20 Hz
/// leaves most poses without one, although no input is silent.
class InputRates {
 public:
  explicit InputRates(const InsConfig& config) : config_(config) {}

  /// Takes the present counts; every 5 s they are compared with the previous ones.
  /** What is too slow, with the rates of all messages, and which key to set; empty if nothing is.
   */
  template <class Decoded>
  const std::string& slowInput(int64_t now, const AssemblerCounts& epochs, const Decoded& decoded) {
    if (start_ && now - start_->utime < kWindowUs) return slow_;
    Counts end{now, epochs, decoded()};
    if (start_) slow_ = compare(end);
    start_ = std::move(end);
    return slow_;
  }

 private:
  static constexpr int64_t kWindowUs = 5'000'000;

  /// The counts at the start or end of a window.
  struct Counts {
    int64_t utime;
    AssemblerCounts epochs;
    ReasonCounts decoded;
  };

  std::string compare(const Counts& end) const;
  std::string messages(const Counts& end) const;
  std::string remedy(const std::string& input, double rate, double needed, const std::string& key,
                     int64_t hold_us) const;

  InsConfig config_;
  std::optional<Counts> start_;
  std::string slow_;
};

}  // namespace tread::ins
