// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

namespace tread {

/// Exit code of a program that cannot use its command line or its input.
inline constexpr int kBadInput = 2;
/// Exit code of a program whose result cannot be written, because the disk is full for instance.
inline constexpr int kNotWritten = 1;

/// What is wrong with a command line, in one line: where, what, and what would be correct.
/** "tread-gap find: '--thread' is not known; did you mean --threads? See tread-gap find --help". */
std::string usageError(const CLI::App& app, const CLI::Error& error);

/// Parses a command line. Returns an exit code if the program ends here: 0 after --help and
/// --version, kBadInput after a usage error (one line on stderr). CLI11's own codes begin at 100;
/// all our programs use these instead.
/** Options of real numbers take finite ones only. */
std::optional<int> parseCommandLine(CLI::App& app, int argc, char** argv);

/// Adds --threads, by default the number of cores; `threads` must outlive the parsing. Only for
/// commands whose output does not depend on the number of threads.
void addThreads(CLI::App& command, int& threads);

/// USER@HOST: the operator's name, unless --by gives another.
std::string operatorName();

/// Runs `run` and returns its exit code. If it throws, prints one line "name: message" on stderr
/// and returns kNotWritten for a WriteError, else kBadInput.
int runProgram(const char* name, const std::function<int()>& run);

}  // namespace tread
