// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

namespace tread {

/// Exit code of a program that cannot use its command line or what it was given to read.
inline constexpr int kBadInput = 2;
/// Exit code of a program whose result cannot be written, because the disk is full for instance.
inline constexpr int kNotWritten = 1;

/// What is wrong with a command line, in one line: where, what, and what would be right.
/** "tread-gap find: '--thread' is not known; did you mean --threads? See tread-gap find --help". */
std::string usageError(const CLI::App& app, const CLI::Error& error);

/// Parses a command line; the exit code if the program ends here: 0 after --help and --version, kBadInput after a
/// usage error, with one line on stderr, as with all our programs (CLI11's own codes begin at 100).
/** Options of real numbers take finite ones only. */
std::optional<int> parseCommandLine(CLI::App& app, int argc, char** argv);

/// Adds --threads with as many as the machine has; `threads` must outlive the parsing. Only for
/// what gives the same bytes with any number of them.
void addThreads(CLI::App& command, int& threads);

/// USER@HOST: who operates the robot from here, unless --by says otherwise.
std::string operatorName();

/// The exit code of `run`; with one line "name: what it threw" on stderr kNotWritten if it throws a
/// WriteError, else kBadInput.
int runProgram(const char* name, const std::function<int()>& run);

}  // namespace tread
