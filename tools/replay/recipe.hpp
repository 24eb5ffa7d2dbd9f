// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

namespace tread::replay {

/// The processes that run from a played log: those without a device.
std::vector<std::string> playableProcesses();

/// The channels to play to a process: what it hears, without what it publishes itself and without
/// what every process publishes, so that it never hears its own past.
std::vector<std::string> playedChannels(const std::string& process);

/// Expression for `lcm-logplayer -e`, anchored: LCM would find INS in INSIDE, too.
std::string channelFilter(const std::string& process);

/// The commands to type, with a line on each: the process, and lcm-logplayer with its filter.
std::string recipeFor(const std::string& process, const std::string& log);

}  // namespace tread::replay
