// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "tools/robot/launch/host.hpp"
#include "tools/robot/launch/supervisor_config.hpp"

namespace tread::launch {

/// Runs supervisord on the written configuration until it ends; tells on standard output what
/// happens. Returns the exit code of tread-launch.
/** SIGINT, SIGTERM and SIGHUP stop everything in order. If the supervisor dies, its processes
 * become our children (PR_SET_CHILD_SUBREAPER): they are asked to end, and killed after
 * `stop_time` seconds. If we die, the supervisor gets SIGTERM and stops everything in order. */
int supervise(const std::string& name, size_t processes, const RunPaths& paths, const RunLock& lock,
              double stop_time);

/// Asks the tread-launch that runs in this folder to stop, and waits for it.
int stopRun(const std::string& name, const RunPaths& paths);

}  // namespace tread::launch
