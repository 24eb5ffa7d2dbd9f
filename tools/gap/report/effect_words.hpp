// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "modules/identification/core/finding.hpp"

namespace tread::gap {

/// One sentence in the words of the workshop with the effect's numbers and its direction.
std::string sentenceOf(const FoundEffect& effect);

/// The same; of a term that acts on top of what the model had with their sum, too.
std::string sentenceOf(const FoundEffect& effect, const ModelDocument& model);

/// The same behind the effect's name.
std::string titledSentenceOf(const FoundEffect& effect, const ModelDocument& model);

/// One sentence for each term of the model that is another one now.
std::vector<std::string> movedSentences(const Finding& finding);

/// What a term and what it acts on top of make together.
struct Total {
  std::string name;
  double value = 0.0;
  std::string unit;
};

/// The total of a parameter in a model; nothing where it acts on top of nothing.
std::optional<Total> totalOf(const std::string& path, const ModelDocument& model);

/// How to check an effect in two minutes, with what its sign may mean beside.
std::string checkOf(const FoundEffect& effect);

}  // namespace tread::gap
