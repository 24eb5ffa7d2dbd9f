// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/soundness/reading.hpp"

namespace tread::gap {

/// The segments of a log: spans, cut where the INS starts a new track.
std::vector<Segment> segmentsOf(const std::vector<HeardSpan>& spans,
                                const std::vector<EncoderSample>& encoders);

/// The executions to predict; `records` in seconds, in order of time.
std::vector<Execution> executionsOf(VehicleLayout layout, const std::vector<Segment>& segments,
                                    const std::vector<Execution>& records);

}  // namespace tread::gap
