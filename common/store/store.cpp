// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/store/store.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "common/store/output_file.hpp"

namespace tread {
namespace {

namespace fs = std::filesystem;

/// Whether a name is a valid entry: letters, digits, '.', '_', '-', no leading dot, at most 200
/// characters, so that it is a visible file directly in the folder on any file system, and none
/// that is being written.
bool isEntryName(const std::string& name) {
  constexpr size_t kLongest = 200;
  return !name.empty() && name.size() <= kLongest && name.front() != '.' && !isUnfinished(name) &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) {
           return (c < 0x80 && std::isalnum(c) != 0) || c == '.' || c == '_' || c == '-';
         });
}

/// The error for such a name.
std::string badEntryName() {
  return "store: an entry's name has only letters, digits, '.', '_' and '-', at most 200, and does "
         "not begin with a dot";
}

std::optional<std::string> readFile(const fs::path& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return std::nullopt;
  std::string content;
  char piece[65536];
  ssize_t count = 1;
  while (count > 0 || (count < 0 && errno == EINTR)) {
    count = ::read(fd, piece, sizeof piece);
    if (count > 0) content.append(piece, static_cast<size_t>(count));
  }
  ::close(fd);
  if (count < 0) return std::nullopt;
  return content;
}

}  // namespace

FileStore::FileStore(std::string folder) : folder_(std::move(folder)) {
  std::error_code failure;
  fs::create_directories(folder_, failure);
  if (!fs::is_directory(folder_, failure) || ::access(folder_.c_str(), W_OK | X_OK) != 0)
    throw std::runtime_error("store: cannot use the folder " + folder_ + " (" +
                             (failure ? failure.message() : std::strerror(errno)) +
                             "); give one that may be written to");
  lock_ = ::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock_ < 0 || ::flock(lock_, LOCK_EX | LOCK_NB) != 0) {
    ::close(lock_);
    throw std::runtime_error("store: the folder " + folder_ +
                             " is in use by another process; end that one first");
  }
  for (const auto& file : fs::directory_iterator(folder_, failure))
    if (isUnfinished(file.path().filename().string())) ::unlink(file.path().c_str());
}

FileStore::~FileStore() {
  ::close(lock_);
}

std::optional<std::string> FileStore::read(const std::string& name) const {
  return isEntryName(name) ? readFile(folder_ + "/" + name) : std::nullopt;
}

std::optional<std::string> FileStore::write(const std::string& name, const std::string& content) {
  if (!isEntryName(name)) return badEntryName();
  const std::string path = folder_ + "/" + name;
  try {
    writeText(path, content);
    return std::nullopt;
  } catch (const WriteError& error) {
    return std::string("store: ") + error.what();
  }
}

void FileStore::remove(const std::string& name) {
  if (!isEntryName(name)) return;
  ::unlink((folder_ + "/" + name).c_str());
  syncFolder(folder_);
}

std::vector<std::string> FileStore::names() const {
  std::vector<std::string> all;
  std::error_code failure;
  for (const auto& file : fs::directory_iterator(folder_, failure)) {
    const std::string name = file.path().filename().string();
    if (isEntryName(name) && file.is_regular_file(failure)) all.push_back(name);
  }
  std::sort(all.begin(), all.end());
  return all;
}

std::optional<std::string> MemoryStore::read(const std::string& name) const {
  const auto found = entries_.find(name);
  if (found == entries_.end()) return std::nullopt;
  return found->second;
}

std::optional<std::string> MemoryStore::write(const std::string& name, const std::string& content) {
  if (!isEntryName(name)) return badEntryName();
  if (!problem_.empty()) return problem_;
  entries_[name] = content;
  return std::nullopt;
}

void MemoryStore::remove(const std::string& name) {
  entries_.erase(name);
}

std::vector<std::string> MemoryStore::names() const {
  std::vector<std::string> all;
  for (const auto& entry : entries_) all.push_back(entry.first);
  return all;
}

std::string readText(const std::string& path) {
  std::optional<std::string> text = readFile(path);
  if (!text) throw std::runtime_error(path + ": cannot be read; check name and rights");
  return std::move(*text);
}

void writeText(const std::string& path, const std::string& text) {
  OutputFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace tread
