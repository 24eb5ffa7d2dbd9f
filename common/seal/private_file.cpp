// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/seal/private_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include "common/store/output_file.hpp"

namespace tread {
namespace {

constexpr size_t kLargestFile = 16'384;  // [bytes]

std::string reason(int error) {
  return std::generic_category().message(error);
}

/// A file that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int descriptor) : descriptor_(descriptor) {}
  ~Descriptor() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return descriptor_; }

 private:
  int descriptor_;
};

std::string octal(mode_t mode) {
  std::ostringstream text;
  text << '0' << std::oct << (mode & 07777);
  return text.str();
}

void requirePrivate(const PrivateFile& file, const struct stat& entry) {
  if (!S_ISREG(entry.st_mode)) file.refuse("is no file", "name another, or " + file.maker);
  if (entry.st_uid != ::geteuid())
    file.refuse("belongs to user " + std::to_string(entry.st_uid) + ", not to user " +
                    std::to_string(::geteuid()) + " who starts this",
                "chown it, or " + file.maker);
  if ((entry.st_mode & 077) != 0)
    file.refuse(
        "others than its owner may use it (mode " + octal(entry.st_mode) + ")",
        "chmod 600 " + file.path + ", and make a new one if somebody else may have read it");
}

}  // namespace

void PrivateFile::refuse(const std::string& problem, const std::string& remedy) const {
  throw std::runtime_error(what + " " + path + ": " + problem + "; " + remedy);
}

bool PrivateFile::isThere() const {
  struct stat entry {};
  return ::lstat(path.c_str(), &entry) == 0;
}

bool PrivateFile::ensure(const std::string& text) const {
  if (isThere()) return false;
  try {
    make(text);
    return true;
  } catch (const std::runtime_error&) {
    if (isThere()) return false;
    throw;
  }
}

/// Opened first and checked afterwards, so that the checked file is the one that is read.
std::string PrivateFile::read() const {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  struct stat entry {};
  if (file.get() < 0 || ::fstat(file.get(), &entry) != 0)
    refuse("cannot be read (" + reason(errno) + ")", "check the path, or " + maker);
  requirePrivate(*this, entry);
  std::string content(kLargestFile, '\0');
  const ssize_t size = ::read(file.get(), content.data(), content.size());
  if (size < 0) refuse("cannot be read (" + reason(errno) + ")", "check the disk");
  content.resize(static_cast<size_t>(size));
  return content;
}

void PrivateFile::make(const std::string& text) const {
  // It appears under its own name complete or not at all: another process may be waiting for it.
  const std::string draft = path + ".new-" + std::to_string(::getpid());
  ::unlink(draft.c_str());  // of one that was killed
  const Descriptor file(
      ::open(draft.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600));
  int failure = errno;
  if (file.get() < 0)
    refuse("cannot be made (" + reason(failure) + ")", "check the path and the rights");
  const bool written =
      ::write(file.get(), text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
      ::fsync(file.get()) == 0;
  const bool linked = written && ::link(draft.c_str(), path.c_str()) == 0;
  failure = errno;
  ::unlink(draft.c_str());
  if (!written) refuse("cannot be written (" + reason(failure) + ")", "check the disk");
  if (!linked)
    refuse("cannot be made (" + reason(failure) + ")",
           failure == EEXIST ? "an existing file is never overwritten: name another one"
                             : "check the path and the rights");
  syncFolder(std::filesystem::absolute(path).parent_path().string());
}

}  // namespace tread
