// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>

#include "common/bus/channels.hpp"
#include "modules/identification/core/drive.hpp"

namespace tread::gap {

/// What tread-import notes in CONFIG of the recording that it imported; nothing for other
/// processes.
std::optional<ImportNote> importNoteOf(const config_t& config);

/// Throws std::runtime_error with one line if a model is of another robot than a log: its gauge
/// differs by more than 2 % from the track with which the recording's commands were made.
void requireSameGauge(const Drive& drive, double gauge);

/// Throws std::runtime_error with one line if two recordings were imported in different ways, so
/// that what differs between them may be the import.
void requireSameImport(const Drive& first, const Drive& second);

/// The same if they are said to be of different robots.
void requireSameRobot(const Drive& first, const Drive& second);

}  // namespace tread::gap
