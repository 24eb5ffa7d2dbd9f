// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/vehicle/effects.hpp"
#include "modules/identification/core/finding.hpp"

// What one must know to read a report and to act on it.
namespace tread::gap {

/// A word and what it means here.
struct Word {
  std::string word;
  std::string meaning;
};

/// The words of a report that are not everybody's.
const std::vector<Word>& glossary();

/// A verdict, what it means and what to do then.
struct Advice {
  GapVerdict verdict;
  std::string meaning;
  std::string next;
};

/// What a verdict means.
const Advice& adviceFor(GapVerdict verdict);

/// What an effect is, its equation and parameters, what it looks like, what it is confused with
/// and how to check it in two minutes.
std::string explanation(const Effect& effect);

/// One line for each effect of the catalogue.
std::string listOfEffects();

/// What `tread-gap explain` says beside effects: start (from a log of one's own to a first run),
/// verdicts (what to do after each) and words (of the report); nothing for another name.
std::optional<std::string> topic(const std::string& name);

/// One line for each topic.
std::string listOfTopics();

}  // namespace tread::gap
