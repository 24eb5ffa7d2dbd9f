// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/patterns/recipe_text.hpp"

#include <vector>

#include "common/report/text.hpp"

namespace tread::patterns {
namespace {

std::string rowText(const std::vector<double>& row, int last_decimals) {
  std::string text = "[";
  for (size_t i = 0; i < row.size(); ++i)
    text += (i > 0 ? ", " : "") + fixed(row[i], i + 1 == row.size() ? last_decimals : 3);
  return text + "]";
}

}  // namespace

std::string recipeText(const DesignedRecipe& recipe, const std::string& comment) {
  std::string text =
      comment + "name: " + recipe.name + "\nperiod: " + fixed(recipe.period, 3) + "\nclasses:\n";
  for (const DesignedClass& motion : recipe.classes)
    text += "  - {name: " + motion.name + ", steady: " + rowText(motion.row, 3) + "}\n";
  text += "patterns:\n";
  for (const DesignedPattern& pattern : recipe.patterns)
    for (size_t i = 0; i < pattern.made.size(); ++i) {
      const CandidatePattern& made = pattern.made[i];
      text += "  - {name: " + pattern.names[i] + ", entry: " + recipe.classes[made.entry].name +
              ", exit: " + recipe.classes[made.exit].name + ", commands: [";
      for (size_t k = 0; k < made.rows.size(); ++k)
        text += (k > 0 ? ", " : "") + rowText(made.rows[k], 2);
      text += "]}\n";
    }
  return text;
}

std::string gainsTable(const DesignedRecipe& recipe) {
  std::string text = formatted("%-8s  %-8s  %s\n", "patterns", "dispersion m", "pattern");
  int count = 0;
  for (const DesignedPattern& pattern : recipe.patterns) {
    count += static_cast<int>(pattern.names.size());
    text += formatted("%8d  %.4f -> %.4f  %s%s%s\n", count, pattern.before, pattern.after,
                      pattern.names.front().c_str(),
                      pattern.names.size() > 1 ? (", " + pattern.names.back()).c_str() : "",
                      pattern.needed ? " (needed)" : "");
  }
  return text;
}

}  // namespace tread::patterns
