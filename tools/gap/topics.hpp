// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>

namespace tread::gap {

/// What `tread-gap explain` says beside effects: start (from a log of one's own to a first run),
/// verdicts (what to do after each) and words (of the report); nothing for another name.
std::optional<std::string> topic(const std::string& name);

/// One line for each topic.
std::string listOfTopics();

}  // namespace tread::gap
