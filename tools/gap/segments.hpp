// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "tools/gap/spans.hpp"

namespace tread::gap {

/// Length of an execution [s].
inline constexpr double kExecutionLength = 2.0;

/// The segments of a log: spans, cut where the INS begins a new track.
std::vector<Segment> segmentsOf(const std::vector<HeardSpan>& spans,
                                const std::vector<EncoderSample>& encoders);

/// The executions to be predicted; `records` in seconds, in order of time.
std::vector<Execution> executionsOf(const std::vector<Segment>& segments,
                                    const std::vector<Execution>& records);

}  // namespace tread::gap
