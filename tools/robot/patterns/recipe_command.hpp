// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

namespace tread::patterns {

CLI::App* addRecipe(CLI::App& app);

}  // namespace tread::patterns
