// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "tools/robot/launch/checks.hpp"
#include "tools/robot/launch/launch_file.hpp"
#include "tools/robot/launch/supervisor_config.hpp"

namespace tread::launch {

/// The folder of the program that runs.
std::string ownFolder();

/// $XDG_STATE_HOME/tread/NAME or ~/.local/state/tread/NAME; throws std::runtime_error without HOME.
std::string defaultRunFolder(const std::string& name);

/// An executable file: a path as it is, a name beside our programs or in PATH; empty if none.
std::string findProgram(const std::string& word, const std::string& bin);

/// The start-up checks of a launch: all that is missing on this host.
std::vector<Finding> checkHost(const LaunchFile& launch, const LaunchSettings& settings);

/// For a run folder without asking for its owner.
FolderFacts folderFacts(const RunPaths& paths);

/// Becomes this program, looked up in PATH; returns only if it cannot be started.
void becomeProgram(std::vector<std::string> words);

/// How a command ended and what it said on both outputs.
struct CommandOutcome {
  int code = -1;  ///< 127 = could not be started, 124 = took too long
  std::string output;
};

/// Runs a command to its end, at most so many seconds.
CommandOutcome runCommand(const std::vector<std::string>& words, double seconds);

}  // namespace tread::launch
