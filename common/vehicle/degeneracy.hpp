// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

namespace tread {

/// Effects (and numbers of the nominal model) that a drive cannot tell from one another.
struct DegeneracyGroup {
  std::string name;
  std::vector<std::string> members;  ///< names of effects or of numbers of the nominal model
  std::string when;                  ///< under which condition; empty = always
  std::string because;               ///< how the one becomes the other
  std::string separates;             ///< the measurement or drive that tells
};

/// All groups: first those that hold for every drive, then those of poor drives.
const std::vector<DegeneracyGroup>& degeneracyGroups();

/// The groups in which an effect is.
std::vector<const DegeneracyGroup*> groupsOf(const std::string& effect);

}  // namespace tread
