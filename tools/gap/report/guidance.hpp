// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "modules/identification/core/finding.hpp"

/// What one must know to read a report and to act on it.
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

/// One for each verdict, in the order of their exit statuses.
const std::vector<Advice>& advices();
const Advice& adviceFor(GapVerdict verdict);

/// How one comes from a log of one's own to a first run, step by step.
const std::vector<Word>& firstSteps();

}  // namespace tread::gap
