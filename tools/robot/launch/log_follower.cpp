// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/launch/log_follower.hpp"

#include <iterator>
#include <utility>

#include <sys/stat.h>

namespace tread::launch {
namespace {

/// 0 if there is no such file.
ino_t inodeOf(const std::string& path) {
  struct stat facts {};
  return stat(path.c_str(), &facts) == 0 ? facts.st_ino : 0;
}

}  // namespace

LogFollower::LogFollower(std::string path)
    : path_(std::move(path)), file_(path_), inode_(inodeOf(path_)) {
  file_.seekg(0, std::ios::end);
}

std::vector<std::string> LogFollower::newLines() {
  std::vector<std::string> lines;
  readRest(lines);
  if (const ino_t inode = inodeOf(path_); inode != 0 && inode != inode_) {
    readRest(lines);  // what was written between the reading and the renaming
    inode_ = inode;
    file_ = std::ifstream(path_);
    readRest(lines);
  }
  return lines;
}

void LogFollower::readRest(std::vector<std::string>& lines) {
  file_.clear();
  partial_.append(std::istreambuf_iterator<char>(file_), {});
  for (size_t end = partial_.find('\n'); end != std::string::npos; end = partial_.find('\n')) {
    lines.push_back(partial_.substr(0, end));
    partial_.erase(0, end + 1);
  }
}

}  // namespace tread::launch
