// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/lab/experiment/adaptation/rivals.hpp"

namespace tread::adaptation {

/// Samples of each training session, ordered by time.
using TrainingSamples = std::vector<std::vector<Sample>>;

/// All rivals, in the order of reports.
const std::vector<std::string>& rivalNames();

/// Slip regression fitted to a whole session at once (Huber loss), without further learning.
/** Not a rival, as it uses the data to be predicted: a bound for what its terms can represent. */
std::unique_ptr<Rival> hindsight(const std::vector<Sample>& session);

/// A rival tuned on training sessions, without knowledge of the ground at hand.
/** With fewer than kLeastSessions sessions it keeps the default prior, and there is no basis. The
 * priors of rls2, rls3 and imm are never tuned. `seed` is for the random features. */
std::unique_ptr<Rival> tunedRival(const std::string& name, const TrainingSamples& training,
                                  uint64_t seed);

}  // namespace tread::adaptation
