// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/config/config_folder.hpp"

#include <filesystem>

namespace tread {

std::string shippedConfig() {
  namespace fs = std::filesystem;
  const fs::path bin = fs::read_symlink("/proc/self/exe").parent_path();
  const fs::path beside = bin.parent_path() / "config", packaged = "/etc/tread";
  std::error_code none;
  for (const fs::path& folder : {beside, packaged})
    if (const fs::path robots = fs::canonical(folder / "robots", none); !none)
      return robots.parent_path().string();
  return beside.string();
}

}  // namespace tread
