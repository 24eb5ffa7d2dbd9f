// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "tools/overlay/drive_pieces.hpp"

namespace tread::overlay {

/// Draws six pieces, evenly chosen over the drive, as measured and by model, and how the models'
/// median errors grow.
/** Throws std::runtime_error with one clear line if the file cannot be written. */
void drawOverlay(const std::string& path, const std::string& title,
                 const std::vector<Piece>& pieces, const std::vector<std::string>& model_names);

}  // namespace tread::overlay
