// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace tread::blindtest {

/// The nominal model's own value of each parameter that a verdict speaks of, with its standard
/// deviation where the model file knows it (else null): {path: {value, sigma}}.
nlohmann::ordered_json nominalNumbers(const std::string& model,
                                      const nlohmann::ordered_json& verdict);

}  // namespace tread::blindtest
