// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/launch/running_robots.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace tread::launch {
namespace {

namespace fs = std::filesystem;

/// This user's private folder; empty if there is none and none can be created.
std::string ownRunFolder() {
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  const std::string base = runtime != nullptr && *runtime == '/' ? runtime : "/tmp";
  const std::string folder = base + "/tread-" + std::to_string(::getuid());
  ::mkdir(folder.c_str(), 0700);
  struct stat facts {};
  // A folder of another user could direct an operator to another robot.
  if (::lstat(folder.c_str(), &facts) != 0 || !S_ISDIR(facts.st_mode) ||
      facts.st_uid != ::getuid() || (facts.st_mode & 077) != 0)
    return {};
  return folder;
}

/// Network namespace of this process.
std::string network() {
  std::error_code none;
  return fs::read_symlink("/proc/self/ns/net", none).string();
}

bool isLocked(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  const bool locked = ::flock(file, LOCK_SH | LOCK_NB) != 0;
  ::close(file);
  return locked;
}

}  // namespace

Announcement::Announcement(const RunningRobot& robot) {
  const std::string folder = ownRunFolder();
  if (folder.empty()) return;
  path_ = folder + "/" + std::to_string(::getpid());
  file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (file_ < 0 || ::flock(file_, LOCK_EX | LOCK_NB) != 0) return;
  // Write into the locked file: a new file in its place would not be locked.
  ::dprintf(file_, "%s\n%s\n%s\n%s\n", network().c_str(), robot.name.c_str(), robot.lcm_url.c_str(),
            robot.key.c_str());
}

Announcement::~Announcement() {
  if (file_ < 0) return;
  ::unlink(path_.c_str());
  ::close(file_);
}

std::vector<RunningRobot> runningRobots() {
  std::vector<RunningRobot> robots;
  const std::string folder = ownRunFolder();
  if (folder.empty()) return robots;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    if (!isLocked(entry.path())) {
      fs::remove(entry.path(), none);
      continue;
    }
    std::ifstream file(entry.path());
    std::string where;
    RunningRobot robot;
    if (std::getline(file, where) && std::getline(file, robot.name) &&
        std::getline(file, robot.lcm_url) && std::getline(file, robot.key) && where == network())
      robots.push_back(robot);
  }
  return robots;
}

RunningRobot findRobot(const std::string& lcm_url, const std::string& key) {
  const char* const usual = std::getenv("LCM_DEFAULT_URL");
  const std::string url = lcm_url.empty() && usual != nullptr ? usual : lcm_url;
  std::vector<RunningRobot> robots = runningRobots();
  if (!url.empty() || usual != nullptr)
    robots.erase(std::remove_if(robots.begin(), robots.end(),
                                [&](const RunningRobot& robot) { return robot.lcm_url != url; }),
                 robots.end());
  if (robots.empty()) return {"", lcm_url, key};
  if (robots.size() == 1) {
    if (!key.empty()) robots.front().key = key;
    robots.front().here = true;
    return robots.front();
  }
  std::string choice;
  for (const RunningRobot& robot : robots)
    choice += "\n  " + robot.name + ": --lcm-url '" + robot.lcm_url + "'";
  throw std::runtime_error("several robots run here; choose one:" + choice);
}

}  // namespace tread::launch
