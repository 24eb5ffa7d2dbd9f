// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/fence/fence_book.hpp"
#include "tools/robot/operator/calls.hpp"

namespace tread::operators {

/// Adds a fence, or removes all fences of a name; repeated until motor bridge and planner show it
/// in FENCES.
class FenceCall : public Call {
 public:
  /// `patience` [s]: how long it is repeated. Signed and sent for the operator of `requester`.
  FenceCall(Bus& bus, const Requester& requester, FenceRequest request, double patience);

  CallResult step(int64_t utime) override;
  std::string describe(int64_t utime) const override;
  void letGo(int64_t utime) override { beacon_.letGo(utime); }

 private:
  /// Whether a process shows the requested state.
  bool shownBy(const std::string& process) const;

  Bus& bus_;
  OperatorBeacon beacon_;
  FenceRequest request_;
  int64_t patience_;                   ///< [us]
  std::map<std::string, bool> shown_;  ///< by process: shows the requested state
  std::optional<int64_t> started_;     ///< [us]
  int64_t next_ = 0;                   ///< [us]
  int64_t seq_ = 0;
};

/// A fence from command-line numbers: x and y of each corner in order [m]. Throws
/// std::invalid_argument with one clear line.
Fence fenceFrom(const std::string& name, bool keep_out, const std::vector<double>& numbers);

}  // namespace tread::operators
