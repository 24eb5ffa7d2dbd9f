// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <CLI/CLI.hpp>

namespace tread::gap {

void addWatch(CLI::App& app, int& status);

}  // namespace tread::gap
