// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/types/message_type.hpp"

namespace tread {

/// Tread's own types, those of lcmtypes/tread.
const MessageTypes& treadTypes();

/// The type of a channel of Tread; nullptr for any other channel.
const MessageType* typeOfChannel(const std::string& channel);

}  // namespace tread
