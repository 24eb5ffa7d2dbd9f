// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/pattern/pattern.hpp"

namespace tread {

/// One error in a set, with its place, so that a file reader can point at the line.
struct PatternProblem {
  enum class Place { kSet, kClass, kPattern };
  Place place = Place::kSet;
  size_t index = 0;     ///< of the class or pattern in the content
  std::string key;      ///< the key in the pattern file, for instance "commands"
  std::string problem;  ///< "what is wrong; what is allowed", without the place

  /// One line with the place in words: "pattern 'left': ...".
  std::string line(const PatternSetContent& content) const;
};

/// The first error in a set; nullopt if there is none.
std::optional<PatternProblem> firstProblem(const PatternSetContent& content);

}  // namespace tread
