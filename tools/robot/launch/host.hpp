// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "tools/robot/launch/checks.hpp"
#include "tools/robot/launch/launch_file.hpp"

namespace tread::launch {

/// Folder of the running executable.
std::string ownFolder();

/// $XDG_STATE_HOME/tread/NAME or ~/.local/state/tread/NAME; throws std::runtime_error without HOME.
std::string defaultRunFolder(const std::string& name);

/// Path of an executable: a path as given, a name next to our programs or in PATH; empty if none.
std::string findProgram(const std::string& word, const std::string& bin);

/// Start-up checks: everything that is missing on this host.
std::vector<HostFinding> checkHost(const LaunchFile& launch, const LaunchSettings& settings);

/// State of a run folder, without its owner.
FolderFacts folderFacts(const RunPaths& paths);

/// Replaces this process by the program, which is looked up in PATH; returns only on failure.
void becomeProgram(std::vector<std::string> words);

/// Exit code and output (both streams) of a command.
struct CommandOutcome {
  int code = -1;  ///< 127 = not started, 124 = timed out
  std::string output;
};

/// Runs a command for at most so many seconds.
CommandOutcome runCommand(const std::vector<std::string>& words, double seconds);

/// Takes TREAD_KEY if the launch file names no key.
void takeNamedKey(LaunchFile& launch);
/// Creates the key of a robot that has none, and returns a line with its path and how a station
/// gets it; empty if the launch has no key. Throws as readKey() does.
std::string provideKey(const LaunchFile& launch);

}  // namespace tread::launch
