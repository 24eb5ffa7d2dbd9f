// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

namespace tread::blind {

/// SHA-256 of bytes as 64 hexadecimal digits; FIPS 180-4.
std::string sha256(const std::string& bytes);

}  // namespace tread::blind
