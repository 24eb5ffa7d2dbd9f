// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace tread {

/// Meaning of a TREAD_KEY that is set but empty.
enum class EmptyKey {
  kIsRefused,
  kIsNone,  ///< only for programs that must work without a key, such as tread-stop
};

/// Adds --key FILE, with the environment variable TREAD_KEY as its default, for hostSealer().
void addKeyOption(CLI::App& app, std::string& path, EmptyKey empty = EmptyKey::kIsRefused);

}  // namespace tread
