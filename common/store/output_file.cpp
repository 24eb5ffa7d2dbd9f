// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/store/output_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace tread {
namespace {

namespace fs = std::filesystem;

constexpr const char* kUnfinished = ".unfinished";
constexpr size_t kBufferSize = 1 << 18;    // [bytes]
constexpr size_t kLongestName = 255 - 30;  // limit of file systems, less our suffix
constexpr int kMostTries = 1000;

std::string reasonOf(int error) {
  return std::generic_category().message(error);
}

/// Target of a symlink, so that the link itself is kept; works without an existing target.
fs::path targetOf(const std::string& path) {
  std::error_code failure;
  fs::path target = fs::absolute(path, failure).lexically_normal();
  for (int i = 0; i < 40 && fs::is_symlink(target, failure) && !fs::exists(target, failure); ++i)
    target = (target.parent_path() / fs::read_symlink(target, failure)).lexically_normal();
  fs::path found = fs::weakly_canonical(target, failure);
  return failure ? target : found;
}

/// The stream of this process that a name refers to (/dev/stdout, /dev/fd/3), else -1. It may be
/// redirected to a file, which must not be replaced while it is being written.
int streamNamed(const std::string& path) {
  if (path == "/dev/stdout") return STDOUT_FILENO;
  if (path == "/dev/stderr") return STDERR_FILENO;
  for (const std::string folder : {"/dev/fd/", "/proc/self/fd/"})
    if (path.rfind(folder, 0) == 0) return std::atoi(path.c_str() + folder.size());
  return -1;
}

/// A device, a pipe, a stream: it cannot be replaced by a file.
bool isSpecial(const std::string& path) {
  std::error_code failure;
  return streamNamed(path) >= 0 ||
         (fs::exists(path, failure) && !fs::is_regular_file(path, failure));
}

/// A unique name beside the target, on the same file system.
std::string unfinishedName(const fs::path& folder, const std::string& name, int attempt) {
  return (folder /
          (name.substr(0, kLongestName) + (name.empty() ? "" : ".") + std::to_string(::getpid()) +
           (attempt == 0 ? "" : "-" + std::to_string(attempt)) + kUnfinished))
      .string();
}

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw std::runtime_error(path + ": cannot be written (" + why + "); check folder and rights");
}

/// The folder itself, or its nearest existing parent.
fs::path existingAbove(fs::path folder) {
  std::error_code failure;
  while (!fs::exists(folder, failure) && folder.has_relative_path()) folder = folder.parent_path();
  return folder;
}

/// Where a file of this output will be created; the folder is created if needed.
fs::path folderFor(const PlannedOutput& output, const fs::path& target) {
  std::error_code failure;
  if (fs::is_directory(target, failure)) return target;
  if (output.kind == PlannedOutput::Kind::kFile) return target.parent_path();
  return existingAbove(target.parent_path());
}

void requireWritable(const PlannedOutput& output, const fs::path& target) {
  const fs::path folder = folderFor(output, target);
  std::error_code failure;
  if (!fs::exists(folder, failure)) refuse(output.path, folder.string() + " is not there");
  if (!fs::is_directory(folder, failure)) refuse(output.path, folder.string() + " is no folder");
  // Permissions are not enough: a file system may be read-only, or not accept files.
  std::string trial = unfinishedName(folder, "trial", 0) + "-XXXXXX";
  const int fd = ::mkstemp(trial.data());
  if (fd < 0) refuse(output.path, folder.string() + ": " + reasonOf(errno));
  ::close(fd);
  ::unlink(trial.c_str());
}

/// Whether a path is inside a folder, at any depth.
bool isWithin(const fs::path& inner, const fs::path& folder) {
  const fs::path way = inner.lexically_relative(folder);
  return !way.empty() && *way.begin() != ".." && way != ".";
}

/// An input folder is assumed to be read completely.
void keepInput(const PlannedOutput& output, const fs::path& target, const std::string& input) {
  std::error_code failure;
  if (input.empty() || !fs::exists(input, failure)) return;
  const fs::path source = targetOf(input);
  const bool to_folder = fs::is_directory(target, failure);
  if (!to_folder) refuseToReplace(output.path, {input});
  if (!to_folder && fs::exists(target, failure) && fs::is_directory(source, failure) &&
      isWithin(target, source))
    throw std::runtime_error(output.path + ": lies in the input " + input +
                             "; name another file to write");
  if (to_folder && (source == target || isWithin(source, target)))
    throw std::runtime_error(output.path + ": the input " + input +
                             " lies there; name another folder to write");
}

bool isEmptyFolder(const fs::path& folder) {
  std::error_code failure;
  const fs::directory_iterator entries(folder, failure);
  return std::all_of(begin(entries), end(entries), [](const auto& entry) {
    return isUnfinished(entry.path().filename().string());
  });
}

void keepExisting(const PlannedOutput& output, const fs::path& target, bool replace) {
  std::error_code failure;
  const bool folder = fs::is_directory(target, failure);
  if (folder && output.kind == PlannedOutput::Kind::kFile) refuse(output.path, "it is a folder");
  if (!folder && output.kind == PlannedOutput::Kind::kFolder && fs::exists(target, failure))
    refuse(output.path, "it is no folder");
  if (replace || !fs::exists(target, failure)) return;
  if (!folder)
    throw std::runtime_error(output.path +
                             ": is there already; name another file, or replace it with --force");
  if (!isEmptyFolder(target))
    throw std::runtime_error(output.path + ": this folder is not empty; name another one, or " +
                             "replace the files of the same names with --force");
}

}  // namespace

OutputFile::OutputFile(const std::string& path, Kind kind) : path_(path) {
  open(kind);
  if (fd_ < 0) fail("cannot be written");
  buffer_.reserve(kBufferSize);
}

OutputFile::~OutputFile() {
  if (fd_ >= 0) ::close(fd_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void OutputFile::open(Kind kind) {
  errno = 0;
  if (const int stream = streamNamed(path_); stream >= 0) {
    std::fflush(nullptr);  // keep the order with earlier output
    fd_ = ::fcntl(stream, F_DUPFD_CLOEXEC, 0);
  } else if (isSpecial(path_)) {
    fd_ = ::open(path_.c_str(), O_WRONLY | O_CLOEXEC);
  } else if (kind == Kind::kGrowing) {
    fd_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  } else {
    openTemporary();
  }
}

void OutputFile::openTemporary() {
  const fs::path target = targetOf(path_);
  target_ = target.string();
  for (int attempt = 0; fd_ < 0 && attempt < kMostTries; ++attempt) {
    const std::string name =
        unfinishedName(target.parent_path(), target.filename().string(), attempt);
    fd_ = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd_ >= 0) temporary_ = name;
    if (fd_ < 0 && errno != EEXIST) return;
  }
  struct stat old {};
  if (fd_ < 0 || ::stat(target_.c_str(), &old) != 0) return;
  // Only root may change a file's owner; others own what they replace or create.
  if (::fchown(fd_, old.st_uid, old.st_gid) == 0) ::fchmod(fd_, old.st_mode & 07777U);
}

void OutputFile::fail(const char* what) {
  if (error_ == 0) error_ = errno;
  throw WriteError(path_ + ": " + what + " (" + reasonOf(error_) +
                   "); check space and permissions");
}

void OutputFile::writeOut(const void* bytes, size_t size) {
  const char* at = static_cast<const char*>(bytes);
  while (error_ == 0 && size > 0) {
    const ssize_t written = ::write(fd_, at, size);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("cannot be written");
    at += written;
    size -= static_cast<size_t>(written);
  }
  if (error_ != 0) fail("cannot be written");
}

void OutputFile::write(const void* bytes, size_t size) {
  if (error_ != 0) fail("cannot be written");
  if (buffer_.size() + size > kBufferSize) flush();
  if (size >= kBufferSize)
    writeOut(bytes, size);
  else if (size > 0)  // size 0 may come with a null pointer
    buffer_.append(static_cast<const char*>(bytes), size);
}

void OutputFile::flush() {
  writeOut(buffer_.data(), buffer_.size());
  buffer_.clear();
}

void OutputFile::commit() {
  flush();
  std::error_code failure;
  const bool on_disk = fs::is_regular_file(temporary_.empty() ? path_ : temporary_, failure);
  if (on_disk && streamNamed(path_) < 0 && ::fsync(fd_) != 0) fail("cannot be written");
  if (::close(std::exchange(fd_, -1)) != 0) fail("cannot be written");
  if (temporary_.empty()) return;
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail("cannot be replaced");
  temporary_.clear();
  syncFolder(fs::path(target_).parent_path().string());
}

OutputFolder::OutputFolder(const std::string& folder) : folder_(folder) {
  std::error_code failure;
  made_ = fs::create_directories(folder, failure);
  for (int attempt = 0; !failure && temporary_.empty() && attempt < kMostTries; ++attempt) {
    const std::string name = unfinishedName(folder, "", attempt);
    if (fs::create_directory(name, failure)) temporary_ = name;
  }
  if (temporary_.empty())
    throw WriteError(folder + ": cannot be made (" + failure.message() +
                     "); check space and permissions");
}

OutputFolder::~OutputFolder() {
  std::error_code failure;
  fs::remove_all(temporary_, failure);
  if (made_) fs::remove(folder_, failure);  // kept if not empty
}

void OutputFolder::commit() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(temporary_))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  for (const std::string& name : names) {
    std::error_code failure;
    fs::rename(fs::path(temporary_) / name, fs::path(folder_) / name, failure);
    if (failure)
      throw WriteError(folder_ + "/" + name + ": cannot be replaced (" + failure.message() + ")");
  }
  syncFolder(folder_);
}

void syncFolder(const std::string& folder) {
  const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return;
  ::fsync(fd);
  ::close(fd);
}

void moveAside(const std::string& path) {
  std::error_code failure;
  if (!fs::is_regular_file(path, failure)) return;
  int number = 1;
  while (fs::exists(path + "." + std::to_string(number), failure)) ++number;
  fs::rename(path, path + "." + std::to_string(number), failure);
  if (failure) throw WriteError(path + ": cannot be moved aside (" + failure.message() + ")");
}

bool isUnfinished(const std::string& name) {
  const std::string ending = kUnfinished;
  return name.size() > ending.size() &&
         name.compare(name.size() - ending.size(), ending.size(), ending) == 0;
}

void checkOutputs(const std::vector<PlannedOutput>& outputs, const std::vector<std::string>& inputs,
                  bool replace) {
  std::vector<fs::path> named;
  for (const PlannedOutput& output : outputs) {
    if (output.path.empty()) continue;
    std::error_code failure;
    if (isSpecial(output.path) && !fs::is_directory(output.path, failure)) continue;
    const fs::path target = targetOf(output.path);
    for (const std::string& input : inputs) keepInput(output, target, input);
    keepExisting(output, target, replace);
    requireWritable(output, target);
    if (std::find(named.begin(), named.end(), target) != named.end())
      throw std::runtime_error(output.path + ": two results cannot be written to one file");
    named.push_back(target);
  }
}

void refuseToReplace(const std::string& output, const std::vector<std::string>& inputs) {
  for (const std::string& input : inputs) {
    std::error_code failure;
    if (fs::equivalent(output, input, failure))
      throw std::runtime_error(output + ": this is the input " + input +
                               "; name another file to write");
  }
}

}  // namespace tread
