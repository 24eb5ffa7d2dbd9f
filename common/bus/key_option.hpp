// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace tread {

/// Adds --key FILE, with the environment variable TREAD_KEY as its default, for hostSealer().
void addKeyOption(CLI::App& app, std::string& path);

}  // namespace tread
