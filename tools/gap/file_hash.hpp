// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

namespace tread::gap {

/// SHA-256 of a file: 64 hexadecimal digits. Uses OpenSSL's libcrypto.
/** Throws std::runtime_error with one clear line if it cannot be read. */
std::string sha256OfFile(const std::string& path);

}  // namespace tread::gap
