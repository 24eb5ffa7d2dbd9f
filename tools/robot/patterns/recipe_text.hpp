// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "tools/robot/patterns/core/recipe_design.hpp"

namespace tread::patterns {

/// The recipe as a file (config/patterns/recipes) with `comment` as its first lines.
std::string recipeText(const DesignedRecipe& recipe, const std::string& comment);

/// Table for people: gain of each pattern.
std::string gainsTable(const DesignedRecipe& recipe);

}  // namespace tread::patterns
