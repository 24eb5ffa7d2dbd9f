// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "tools/gap/known_commands.hpp"

namespace tread::gap {

/// An INS message within a span of known commands.
struct InsReading {
  InsSample sample;        ///< yaw as the message says; pose NaN where there is none or it is held
  bool fresh = false;      ///< whether the sample has a pose
  bool new_track = false;  ///< the first pose after a jump
};

/// A time in which the INS repeated its pose although the vehicle was told to move.
struct HeldPose {
  double begin = 0.0;  ///< [s]
  double end = 0.0;    ///< [s]
};

/// What the INS said in a span.
struct SpanReadings {
  std::vector<InsReading> readings;  ///< in order of time
  std::vector<HeldPose> held;        ///< in order of time
  size_t poses = 0;                  ///< messages with a pose, held ones too, while it drove
  size_t repeated = 0;               ///< of these: held
};

/// The INS messages in a span. Equal poses are real where nothing is commanded for a second, and
/// held elsewhere.
SpanReadings insReadings(const LogMessages& messages, const CommandSpan& span);

}  // namespace tread::gap
