// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace tread {

/// The schema (JSON Schema) of such a message, restricted to the fields that we fill.
std::string sceneSchema(const std::string& name);
/// Topics with their schemas' names.
const std::vector<std::pair<std::string, std::string>>& sceneTopics();

}  // namespace tread
