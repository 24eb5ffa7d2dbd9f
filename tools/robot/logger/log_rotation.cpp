// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/logger/log_rotation.hpp"

#include <filesystem>

namespace tread::launch {
namespace {

namespace fs = std::filesystem;

std::string numbered(const std::string& file, int number) {
  return file + "." + std::to_string(number);
}

}  // namespace

void makeRoomForLog(const std::string& file, int keep) {
  int gap = 0;
  while (gap < keep && fs::exists(numbered(file, gap))) ++gap;
  for (int i = gap - 1; i >= 0; --i) {
    if (i + 1 >= keep)
      fs::remove(numbered(file, i));
    else
      fs::rename(numbered(file, i), numbered(file, i + 1));
  }
}

}  // namespace tread::launch
