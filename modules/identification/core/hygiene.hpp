// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "modules/identification/core/drive.hpp"
#include "modules/identification/core/lag_table.hpp"
#include "modules/identification/core/note_book.hpp"

namespace tread::gap {

/// Whether a drive's measurements belong together, before anything is fitted (gap.md 4.2, stage 0):
/// gyro against heading (sign, scale, offset of the clocks), motion against commands (sign, order
/// in time, clocks that jump), jumps, fixes, noise and bias at standstill, and what was driven.
/** Fatal are only contradictions that no effect of the catalogue makes. The reader's own notes
 * (Drive::notes) are not repeated. */
std::vector<HygieneNote> checkHygiene(const Drive& drive);

/// How the heading turns beside the gyro; nothing where one of them is missing or nothing turns.
/** lag: of the heading behind the gyro [s]; slope: heading over gyro; offset: -bias * slope. */
std::optional<LagMatch> headingBesideGyro(const Drive& drive);

/// Stretches whose poses do not belong to one frame: the heading turns otherwise than the gyro, or
/// the way leads elsewhere than the heading, far more than in the others. Indices in order.
/** Only among ten or more stretches (a recording in steps), as others do not tell. */
std::vector<size_t> brokenStretches(const Drive& drive);

/// Takes out stretches (and their executions).
void removeStretches(const std::vector<size_t>& stretches, Drive& drive);

// Parts of checkHygiene().
void checkGyro(const Drive& drive, NoteBook& notes);
void checkCommands(const Drive& drive, const std::vector<PoseIncrement>& increments,
                   NoteBook& notes);
void checkPoses(const Drive& drive, const std::vector<PoseIncrement>& increments, NoteBook& notes);
void describeStandstill(const Drive& drive, NoteBook& notes);
void describeDriving(const Drive& drive, const std::vector<PoseIncrement>& increments,
                     NoteBook& notes);

}  // namespace tread::gap
