// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

namespace tread {

/// A file that only its owner may read. All functions throw std::runtime_error, one line: what,
/// where, what to do.
struct PrivateFile {
  std::string what;  ///< "key"
  std::string path;
  std::string maker;  ///< how to create one: "make one with tread-key new"

  /// Its text; refused if it belongs to another user, or if others may read or write it.
  std::string read() const;
  /// Creates it with mode 0600, whole or not at all; never overwrites an existing file.
  void make(const std::string& text) const;
  /// The same if there is none yet, safe against concurrent calls. True if this call created it.
  bool ensure(const std::string& text) const;
  /// Whether a file of this name exists.
  bool isThere() const;
  [[noreturn]] void refuse(const std::string& problem, const std::string& remedy) const;
};

}  // namespace tread
