// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/types/message_type.hpp"

namespace tread::recordings {

/// Types of other projects' robots, MAEBot and MBot; one for each fingerprint.
const MessageTypes& foreignTypes();

}  // namespace tread::recordings
