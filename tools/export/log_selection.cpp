// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/export/log_export.hpp"

#include <cmath>

namespace tread::exporting {

bool SelectedEvents::isWanted(const LogEvent& event) {
  if (begun_ < 0) begun_ = event.utime;
  const auto since = static_cast<double>(event.utime - begun_);  // [us]
  if (since < std::round(1e6 * selection_.from) || since > std::round(1e6 * selection_.to))
    return false;
  return selection_.channels.empty() || selection_.channels.count(event.channel) > 0;
}

}  // namespace tread::exporting
