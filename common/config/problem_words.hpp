// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <exception>
#include <string>

namespace tread {

/// Message of a caught exception for users. Our own messages are kept; those of the standard
/// library and other libraries ("std::bad_cast", "stoi", "filesystem error: ...") become a
/// sentence.
std::string wordsOf(const std::exception& problem);

}  // namespace tread
