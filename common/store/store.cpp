// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/store/store.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace tread {
namespace {

namespace fs = std::filesystem;

/// Whether a name may stand for an entry: letters, digits, '.', '_', '-', no dot in front, at most
/// 200 characters, so that it is a visible file of the folder itself on any file system.
bool isEntryName(const std::string& name) {
  constexpr size_t kLongest = 200;
  return !name.empty() && name.size() <= kLongest && name.front() != '.' &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) {
           return (c < 0x80 && std::isalnum(c) != 0) || c == '.' || c == '_' || c == '-';
         });
}

/// The line that refuses such a name.
std::string badEntryName() {
  return "store: an entry's name has only letters, digits, '.', '_' and '-', at most 200, and does "
         "not begin with a dot";
}

/// A file descriptor that is closed at the end of its scope.
class Descriptor {
 public:
  Descriptor(const std::string& path, int flags, mode_t mode = 0)
      : fd_(::open(path.c_str(), flags | O_CLOEXEC, mode)) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int get() const { return fd_; }
  bool isOpen() const { return fd_ >= 0; }
  /// False if the system reports a late write error.
  bool close() {
    const int fd = std::exchange(fd_, -1);
    return fd < 0 || ::close(fd) == 0;
  }

 private:
  int fd_;
};

bool writeAll(int fd, const std::string& content) {
  size_t done = 0;
  while (done < content.size()) {
    const ssize_t written = ::write(fd, content.data() + done, content.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    done += static_cast<size_t>(written);
  }
  return true;
}

/// Writes a new file and waits until its content is on the disk.
bool writeDurably(const std::string& path, const std::string& content) {
  Descriptor file(path, O_WRONLY | O_CREAT | O_TRUNC, 0644);
  return file.isOpen() && writeAll(file.get(), content) && ::fsync(file.get()) == 0 && file.close();
}

/// Waits until the names of a folder are on the disk: without it a rename may be lost with the
/// power.
bool syncFolder(const std::string& folder) {
  const Descriptor entry(folder, O_RDONLY | O_DIRECTORY);
  return entry.isOpen() && ::fsync(entry.get()) == 0;
}

/// A file that a crash left behind: hidden, so that it is never taken for an entry.
bool isLeftover(const std::string& name) {
  constexpr const char* kEnding = ".tmp";
  return name.size() > 5 && name.front() == '.' && name.substr(name.size() - 4) == kEnding;
}

}  // namespace

FileStore::FileStore(std::string folder) : folder_(std::move(folder)) {
  std::error_code failure;
  fs::create_directories(folder_, failure);
  if (!fs::is_directory(folder_, failure) || ::access(folder_.c_str(), W_OK | X_OK) != 0)
    throw std::runtime_error("store: cannot use the folder " + folder_ + " (" +
                             (failure ? failure.message() : std::strerror(errno)) +
                             "); give one that may be written to");
  for (const auto& file : fs::directory_iterator(folder_, failure))
    if (isLeftover(file.path().filename().string())) ::unlink(file.path().c_str());
}

std::optional<std::string> FileStore::read(const std::string& name) const {
  if (!isEntryName(name)) return std::nullopt;
  const Descriptor file(folder_ + "/" + name, O_RDONLY);
  if (!file.isOpen()) return std::nullopt;
  std::string content;
  char piece[65536];
  for (;;) {
    const ssize_t count = ::read(file.get(), piece, sizeof piece);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return std::nullopt;
    if (count == 0) return content;
    content.append(piece, static_cast<size_t>(count));
  }
}

std::optional<std::string> FileStore::write(const std::string& name, const std::string& content) {
  if (!isEntryName(name)) return badEntryName();
  const std::string path = folder_ + "/" + name;
  // In the same folder, because a rename is atomic only within a file system.
  const std::string temporary = folder_ + "/." + name + "." + std::to_string(::getpid()) + ".tmp";
  if (writeDurably(temporary, content) && ::rename(temporary.c_str(), path.c_str()) == 0 &&
      syncFolder(folder_))
    return std::nullopt;
  const std::string reason = std::strerror(errno);
  ::unlink(temporary.c_str());
  return "store: cannot write " + path + " (" + reason + "); check space and permissions";
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

}  // namespace tread
