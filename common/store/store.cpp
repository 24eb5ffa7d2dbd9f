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
  Descriptor(const fs::path& path, int flags, mode_t mode = 0)
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

/// Writes a file and, if `durably`, waits until its content is on the disk.
bool writeFile(const fs::path& path, const std::string& content, bool durably) {
  Descriptor file(path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  return file.isOpen() && writeAll(file.get(), content) && (!durably || ::fsync(file.get()) == 0) &&
         file.close();
}

/// Waits until the names of a folder are on the disk: without it a rename may be lost with the
/// power.
bool syncFolder(const fs::path& folder) {
  const Descriptor entry(folder, O_RDONLY | O_DIRECTORY);
  return entry.isOpen() && ::fsync(entry.get()) == 0;
}

/// Puts a file in the place of another, whole or not at all. False, with errno, if that fails.
bool replaceFile(const fs::path& path, const std::string& content) {
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  // In the same folder, because a rename is atomic only within a file system.
  const fs::path temporary =
      folder / ("." + path.filename().string() + "." + std::to_string(::getpid()) + ".tmp");
  if (writeFile(temporary, content, true) && ::rename(temporary.c_str(), path.c_str()) == 0 &&
      syncFolder(folder))
    return true;
  const int error = errno;
  ::unlink(temporary.c_str());
  errno = error;
  return false;
}

/// A file that a crash left behind: hidden, so that it is never taken for an entry.
bool isLeftover(const std::string& name) {
  constexpr const char* kEnding = ".tmp";
  return name.size() > 5 && name.front() == '.' && name.substr(name.size() - 4) == kEnding;
}

std::optional<std::string> readFile(const fs::path& path) {
  const Descriptor file(path, O_RDONLY);
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

/// Where a link leads, so that the link itself stays.
fs::path targetOf(const std::string& path) {
  std::error_code failure;
  const fs::path target = fs::weakly_canonical(path, failure);
  return failure ? fs::path(path) : target;
}

/// A device, a pipe: there is nothing to put in its place.
bool isSpecial(const std::string& path) {
  std::error_code failure;
  return fs::exists(path, failure) && !fs::is_regular_file(path, failure);
}

[[noreturn]] void refuse(const std::string& path) {
  throw std::runtime_error(path + ": cannot be written; check folder and rights");
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
    if (isLeftover(file.path().filename().string())) ::unlink(file.path().c_str());
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
  if (replaceFile(path, content)) return std::nullopt;
  return "store: cannot write " + path + " (" + std::strerror(errno) +
         "); check space and permissions";
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
  const bool written =
      isSpecial(path) ? writeFile(path, text, false) : replaceFile(targetOf(path), text);
  if (!written) refuse(path);
}

void requireWritable(const std::string& path) {
  std::error_code failure;
  const fs::path target = targetOf(path);
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  const bool there = fs::exists(path, failure);
  const bool may =
      there ? ::access(path.c_str(), W_OK) == 0
            : fs::is_directory(folder, failure) && ::access(folder.c_str(), W_OK | X_OK) == 0;
  if (!may || fs::is_directory(path, failure)) refuse(path);
}

void refuseToReplace(const std::string& output, const std::vector<std::string>& inputs) {
  for (const std::string& input : inputs) {
    std::error_code failure;
    if (fs::equivalent(output, input, failure))
      throw std::runtime_error(output + ": this is the input " + input +
                               "; give another file to write");
  }
}

void checkOutputs(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs) {
  std::vector<fs::path> named;
  for (const std::string& output : outputs) {
    if (output.empty()) continue;
    refuseToReplace(output, inputs);
    requireWritable(output);
    if (isSpecial(output)) continue;
    const fs::path target = targetOf(fs::absolute(output));
    if (std::find(named.begin(), named.end(), target) != named.end())
      throw std::runtime_error(output + ": two results cannot be written to one file");
    named.push_back(target);
  }
}

void writeOutput(const std::string& path, const std::string& text,
                 const std::vector<std::string>& inputs) {
  refuseToReplace(path, inputs);
  writeText(path, text);
}

}  // namespace tread
