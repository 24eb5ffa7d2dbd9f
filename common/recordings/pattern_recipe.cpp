// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/recordings/pattern_recipe.hpp"

#include <algorithm>
#include <cmath>

namespace tread::drive_patterns {
namespace {

constexpr double kLeastReach = 0.01;

void readPattern(ConfigReader& reader, PatternRecipe& recipe) {
  PatternWish wish;
  reader.text("name", wish.name, true);
  std::vector<double> command;
  reader.numbers("command", command, 2, {-20.0, 20.0}, "m/s, rad/s", true);
  wish.command = {command[0], command[1]};
  recipe.patterns.push_back(wish);
  if (!reader.has("mirror")) return;
  reader.text("mirror", wish.name);
  wish.command.w = -wish.command.w;
  recipe.patterns.push_back(wish);
}

}  // namespace

size_t PatternRecipe::samples() const {
  return static_cast<size_t>(std::llround(length / period));
}

BodyCommand PatternRecipe::reach() const {
  BodyCommand largest{kLeastReach, kLeastReach};
  for (const PatternWish& wish : patterns) {
    largest.v = std::max(largest.v, std::abs(wish.command.v));
    largest.w = std::max(largest.w, std::abs(wish.command.w));
  }
  return largest;
}

PatternRecipe defaultRecipe() {
  PatternRecipe recipe;
  recipe.patterns = {{"straight", {2.5, 0.0}},    {"left", {2.5, 1.5}},
                     {"right", {2.5, -1.5}},      {"hard_left", {1.8, 2.2}},
                     {"hard_right", {1.8, -2.2}}, {"spin_left", {0.0, 2.4}},
                     {"spin_right", {0.0, -2.4}}, {"reverse", {-2.5, 0.0}}};
  return recipe;
}

PatternRecipe readRecipe(ConfigReader reader) {
  PatternRecipe recipe;
  reader.text("name", recipe.name, true);
  int64_t neighbours = recipe.neighbours;
  int64_t deviations = recipe.deviations;
  reader.integer("neighbours", neighbours, {6, 1000}, "1");
  reader.integer("deviations", deviations, {10, 500}, "1");
  recipe.neighbours = static_cast<int>(neighbours);
  recipe.deviations = static_cast<int>(deviations);
  for (ConfigReader& pattern : reader.sections("patterns", true)) readPattern(pattern, recipe);
  reader.finish();
  if (recipe.patterns.empty()) throw reader.error("patterns", "none; at least one is needed");
  for (size_t i = 0; i < recipe.patterns.size(); ++i)
    for (size_t j = 0; j < i; ++j)
      if (recipe.patterns[i].name == recipe.patterns[j].name)
        throw reader.error("patterns",
                           "two are called '" + recipe.patterns[i].name + "'; names are unique");
  return recipe;
}

PatternRecipe scaledRecipe(PatternRecipe recipe, double v_factor, double w_factor) {
  for (PatternWish& wish : recipe.patterns) {
    wish.command.v *= v_factor;
    wish.command.w *= w_factor;
  }
  return recipe;
}

}  // namespace tread::drive_patterns
