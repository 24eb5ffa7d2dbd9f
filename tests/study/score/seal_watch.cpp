// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/score/seal_watch.hpp"

#include <sys/inotify.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <stdexcept>

namespace fs = std::filesystem;

namespace tread::blindtest {

SealWatch::SealWatch(const std::string& folder) : descriptor_(inotify_init1(IN_NONBLOCK)) {
  fs::permissions(folder, fs::perms::owner_all);
  const int watch = inotify_add_watch(descriptor_, folder.c_str(),
                                      IN_OPEN | IN_ACCESS | IN_MODIFY | IN_ATTRIB | IN_MOVE);
  const int problem = errno;
  fs::permissions(folder, fs::perms::none);
  if (watch < 0) {
    close(descriptor_);
    throw std::runtime_error(folder + ": cannot be watched: " + std::strerror(problem));
  }
  touched();  // shutting the folder is seen, too
}

SealWatch::~SealWatch() {
  close(descriptor_);
}

std::vector<std::string> SealWatch::touched() {
  std::vector<std::string> names;
  alignas(inotify_event) char buffer[8192];
  for (ssize_t size; (size = read(descriptor_, buffer, sizeof buffer)) > 0;)
    for (const char* at = buffer; at < buffer + size;) {
      const auto* event = reinterpret_cast<const inotify_event*>(at);
      names.emplace_back(event->len > 0 ? event->name : "the folder itself");
      at += sizeof(inotify_event) + event->len;
    }
  return names;
}

}  // namespace tread::blindtest
