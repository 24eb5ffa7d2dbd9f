// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <exception>
#include <string>

namespace tread {

/// What a caught exception says to a user. Our own words stay as they are; those of the language's
/// library and of others ("std::bad_cast", "stoi", "filesystem error: ...") become a sentence.
std::string wordsOf(const std::exception& problem);

}  // namespace tread
