// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cctype>
#include <string>

namespace tread {

/// Whether a name may stand for an entry: letters, digits, '.', '_', '-', no dot in front, at most
/// 200 characters, so that it is a visible file of the folder itself on any file system.
inline bool isEntryName(const std::string& name) {
  constexpr size_t kLongest = 200;
  return !name.empty() && name.size() <= kLongest && name.front() != '.' &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) {
           return (c < 0x80 && std::isalnum(c) != 0) || c == '.' || c == '_' || c == '-';
         });
}

/// The line that refuses such a name.
inline std::string badEntryName() {
  return "store: an entry's name has only letters, digits, '.', '_' and '-', at most 200, and does "
         "not begin with a dot";
}

}  // namespace tread
