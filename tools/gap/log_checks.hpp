// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "modules/identification/core/note_book.hpp"
#include "tools/gap/log_messages.hpp"
#include "tools/gap/stretches.hpp"

namespace tread::gap {

/// Missing or foreign channels, commands of two kinds, silences, jumps and frozen poses.
void checkChannels(const LogMessages& messages, const std::vector<HeardSpan>& spans,
                   NoteBook& notes);

/// Clocks that jump or go back.
void checkClocks(const LogMessages& messages, NoteBook& notes);

/// A pause after which the robot is where it was one message later, although it moves: time went
/// on, the robot did not. Part of checkClocks().
void checkPauses(const LogMessages& messages, NoteBook& notes);

/// Two robots (or two publishers of a channel) in one log.
void checkPublishers(const LogMessages& messages, NoteBook& notes);

}  // namespace tread::gap
