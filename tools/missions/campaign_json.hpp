// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "tools/missions/report.hpp"

namespace tread::missions {

/// What writeJson() writes of a campaign.
nlohmann::ordered_json campaignJson(const Campaign& campaign);

/// Throws std::runtime_error with one clear line if the file cannot be written.
void writeJsonFile(const std::string& path, const nlohmann::ordered_json& json);

}  // namespace tread::missions
