// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/vehicle/effects.hpp"
#include "modules/identification/core/finding.hpp"

namespace tread::gap {

/// A term and its meaning.
struct Word {
  std::string word;
  std::string meaning;
};

/// Technical terms of a report.
const std::vector<Word>& glossary();

/// A verdict, its meaning and the next step.
struct Advice {
  GapVerdict verdict;
  std::string meaning;
  std::string next;
};

/// Meaning of a verdict.
const Advice& adviceFor(GapVerdict verdict);

/// Explains an effect: meaning, equation and parameters, appearance in data, confusable effects,
/// and a check of two minutes.
std::string explanation(const Effect& effect);

/// One line for each effect of the catalogue.
std::string listOfEffects();

/// Text of `tread-gap explain` for a topic: start (from a log to a first run), verdicts (and next
/// steps), words (of the report); nullopt for other names.
std::optional<std::string> topic(const std::string& name);

/// One line for each topic.
std::string listOfTopics();

}  // namespace tread::gap
