// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace tread {

/// What a TREAD_KEY that is set but empty means.
enum class EmptyKey {
  kIsRefused,
  kIsNone,  ///< only for what must work without a key, as stopping does
};

/// Adds --key FILE, with the environment variable TREAD_KEY as its default, for hostSealer().
void addKeyOption(CLI::App& app, std::string& path, EmptyKey empty = EmptyKey::kIsRefused);

}  // namespace tread
