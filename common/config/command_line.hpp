// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>

#include <CLI/CLI.hpp>

namespace tread {

/// Parses a command line; the exit code if the program ends here: 0 after --help, 2 after a usage
/// error, as with all our programs (CLI11's own codes begin at 100).
inline std::optional<int> parseCommandLine(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return std::nullopt;
}

}  // namespace tread
