// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>

#include "common/vehicle/effects.hpp"

namespace tread::gap {

/// What an effect is, its equation and parameters, what it looks like, what it is confused with
/// and how to check it in two minutes.
std::string explanation(const Effect& effect);

/// One line for each effect of the catalogue.
std::string listOfEffects();

/// Text in lines of at most `width` letters, each after the first one indented.
std::string wrapped(const std::string& text, size_t width, size_t indent);

/// What `tread-gap explain` says beside effects: start (from a log of one's own to a first run),
/// verdicts (what to do after each) and words (of the report); nothing for another name.
std::optional<std::string> topic(const std::string& name);

/// One line for each topic.
std::string listOfTopics();

}  // namespace tread::gap
