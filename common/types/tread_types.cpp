// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>

#include "common/bus/channels.hpp"
#include "common/types/message_type.hpp"

namespace tread {

/// The .lcm files, one after the other; made by the build.
extern const char* const kTypesText[];

const MessageTypes& treadTypes() {
  static const MessageTypes types = MessageTypes::fromText(kTypesText[0]);
  return types;
}

const MessageType* typeOfChannel(const std::string& channel) {
  const auto spec =
      std::find_if(kChannels.begin(), kChannels.end(),
                   [&](const ChannelSpec& candidate) { return channel == candidate.name; });
  return spec == kChannels.end() ? nullptr : treadTypes().find(spec->type);
}

}  // namespace tread
