// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include <yaml-cpp/yaml.h>

namespace tread {

/// The only document of a YAML text; null for an empty text.
/** Throws ConfigError with name:line for bad syntax and for a second document. */
YAML::Node loadOneDocument(const std::string& text, const std::string& name);

}  // namespace tread
