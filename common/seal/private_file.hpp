// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

namespace tread {

/// A file that only its owner may read. All functions throw std::runtime_error, one line: what,
/// where, what to do.
struct PrivateFile {
  std::string what;   ///< "key"
  std::string path;
  std::string maker;  ///< how one is made: "make one with tread-key new"

  /// Its text; refused if it belongs to another user than that of this process, or if others may
  /// read or write it.
  std::string read() const;
  /// Makes it with mode 0600, whole or not at all; an existing file is never overwritten.
  void make(const std::string& text) const;
  /// The same where there is none yet, whoever else does so at the same time. True if this made it.
  bool ensure(const std::string& text) const;
  /// Whether there is something of this name.
  bool isThere() const;
  [[noreturn]] void refuse(const std::string& problem, const std::string& remedy) const;
};

}  // namespace tread
