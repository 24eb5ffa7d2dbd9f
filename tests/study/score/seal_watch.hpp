// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

namespace tread::blindtest {

/// Sees whoever opens or reads a folder's files, or opens its doors; root included (inotify).
class SealWatch {
 public:
  /// Watches a folder of mode 000 and leaves it at that. Throws std::runtime_error with one line.
  explicit SealWatch(const std::string& folder);
  ~SealWatch();
  SealWatch(const SealWatch&) = delete;
  SealWatch& operator=(const SealWatch&) = delete;

  /// What was touched since the last call: names of files, "the folder itself" for that.
  std::vector<std::string> touched();

 private:
  int descriptor_ = -1;
};

}  // namespace tread::blindtest
