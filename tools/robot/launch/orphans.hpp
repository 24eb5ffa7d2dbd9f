// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

namespace tread::launch {

/// Ends all children of this process, also those that a dead supervisor has left to it
/// (PR_SET_CHILD_SUBREAPER): asks with SIGINT, kills after `stop_time` seconds, and reaps them.
void endChildren(double stop_time);

}  // namespace tread::launch
