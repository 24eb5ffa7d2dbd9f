// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors

#include "tools/robot/export/log_selection.hpp"

#include <cmath>

#include "common/types/message_json.hpp"
#include "common/types/tread_types.hpp"

namespace tread::exporting {

std::optional<JsonMessage> countedJson(const LogEvent& event, ExportCounts& counts) {
  const MessageType* const type = typeOfChannel(event.channel);
  auto json = type == nullptr ? std::nullopt : jsonOf(treadTypes(), *type, event.bytes);
  if (!json) {
    ++counts.left_out[event.channel + (type == nullptr ? ": not of Tread" : ": broken")];
    return std::nullopt;
  }
  ++counts.written[event.channel];
  return JsonMessage{type, std::move(*json)};
}

bool SelectedEvents::isWanted(const LogEvent& event) {
  if (begun_ < 0) begun_ = event.utime;
  const auto since = static_cast<double>(event.utime - begun_);  // [us]
  if (since < std::round(1e6 * selection_.from) || since > std::round(1e6 * selection_.to))
    return false;
  return selection_.channels.empty() || selection_.channels.count(event.channel) > 0;
}

}  // namespace tread::exporting
