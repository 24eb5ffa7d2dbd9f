// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace tread::gap {

struct SearchSettings {
  double alpha =
      0.02;  ///< probability that the first test over the whole catalogue names something wrongly
  double alpha_more = 0.05;  ///< the same of every further test, once something is there
  int draws = 1999;          ///< of the bootstrap
  size_t tried = 4;          ///< effects that are refitted at a time
  size_t most = 8;           ///< effects that are added at most
  bool calibrate = false;    ///< the numbers of the nominal model are free
  double least_gain = 0.01;  ///< of the end error; less is real but negligible; 0 = none is
  /// A person's last word: in from calibration on, whatever tests say.
  std::vector<std::string> accepted;
  std::vector<std::string> rejected;  ///< never considered
  bool all_sized = false;             ///< ends at once where an accepted one cannot be sized
  uint64_t seed = 1;
};

}  // namespace tread::gap
