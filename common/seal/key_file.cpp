// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/seal/key_file.hpp"

#include <fcntl.h>
#include <sodium.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <system_error>

namespace tread {
namespace {

constexpr const char* kComment =
    "# A key of Tread: who reads this file can drive the robot. Made by tread-key new.\n";
constexpr size_t kLargestFile = 4096;  // [bytes]

[[noreturn]] void refuse(const std::string& path, const std::string& what,
                         const std::string& remedy) {
  throw std::runtime_error("key " + path + ": " + what + "; " + remedy);
}

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

void requirePrivate(const std::string& path, const struct stat& entry) {
  if (!S_ISREG(entry.st_mode)) refuse(path, "is no file", "name the file that tread-key new made");
  if (entry.st_uid != ::geteuid())
    refuse(path,
           "belongs to user " + std::to_string(entry.st_uid) + ", not to user " +
               std::to_string(::geteuid()) + " who starts this",
           "chown it, or make another one with tread-key new");
  if ((entry.st_mode & 077) != 0)
    refuse(path, "others than its owner may use it (mode " + octal(entry.st_mode) + ")",
           "chmod 600 " + path + ", and make a new one if somebody else may have read it");
}

/// Opened first and asked afterwards, so that it is the file that was looked at.
std::string privateContent(const std::string& path) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  struct stat entry {};
  if (file.get() < 0 || ::fstat(file.get(), &entry) != 0)
    refuse(path, "cannot be read (" + reason(errno) + ")",
           "check the path, or make one with tread-key new");
  requirePrivate(path, entry);
  std::string content(kLargestFile, '\0');
  const ssize_t size = ::read(file.get(), content.data(), content.size());
  if (size < 0) refuse(path, "cannot be read (" + reason(errno) + ")", "check the disk");
  content.resize(static_cast<size_t>(size));
  return content;
}

/// Whether the line is a key, which it reads then.
bool isKey(const std::string& line, SealKey& key) {
  const char* end = nullptr;
  size_t size = 0;
  return line.size() == 2 * key.bytes.size() &&
         sodium_hex2bin(key.bytes.data(), key.bytes.size(), line.c_str(), line.size(), nullptr,
                        &size, &end) == 0 &&
         size == key.bytes.size();
}

void requireSodium() {
  if (sodium_init() < 0) throw std::runtime_error("libsodium cannot be used");
}

/// A hash of 64 bits.
uint64_t hashOf(const std::string& text) {
  uint8_t hash[16];
  crypto_generichash(hash, sizeof hash, reinterpret_cast<const uint8_t*>(text.data()), text.size(),
                     nullptr, 0);
  uint64_t value = 0;
  for (size_t i = 0; i < 8; ++i) value = value << 8 | hash[i];
  return value;
}

/// Differs for each boot of this host.
uint64_t hostSession() {
  constexpr const char* kBootId = "/proc/sys/kernel/random/boot_id";
  std::string boot_id;
  if (!std::getline(std::ifstream(kBootId), boot_id) || boot_id.empty())
    throw std::runtime_error(std::string(kBootId) +
                             " cannot be read, so messages cannot be sealed; mount /proc");
  return hashOf(boot_id);
}

uint64_t newSender() {
  uint64_t sender = 0;
  randombytes_buf(&sender, sizeof sender);
  return sender;
}

}  // namespace

SealKey readKey(const std::string& path) {
  requireSodium();
  std::istringstream lines(privateContent(path));
  SealKey key;
  int keys = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line.front() == '#') continue;
    if (++keys > 1 || !isKey(line, key)) keys = 2;
  }
  if (keys != 1)
    refuse(path, "holds no key (one line of 64 hexadecimal digits)", "make one with tread-key new");
  return key;
}

void writeNewKey(const std::string& path) {
  requireSodium();
  SealKey key;
  randombytes_buf(key.bytes.data(), key.bytes.size());
  char digits[2 * sizeof key.bytes + 1];
  sodium_bin2hex(digits, sizeof digits, key.bytes.data(), key.bytes.size());
  const std::string text = kComment + std::string(digits) + "\n";
  // Under its own name it is there whole or not at all: somebody else may be waiting for it.
  const std::string draft = path + ".new-" + std::to_string(::getpid());
  const Descriptor file(
      ::open(draft.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600));
  int failure = errno;
  if (file.get() < 0)
    refuse(path, "cannot be made (" + reason(failure) + ")", "check the path and the rights");
  const bool written =
      ::write(file.get(), text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
      ::fsync(file.get()) == 0;
  const bool linked = written && ::link(draft.c_str(), path.c_str()) == 0;
  failure = errno;
  ::unlink(draft.c_str());
  if (!written) refuse(path, "cannot be written (" + reason(failure) + ")", "check the disk");
  if (!linked)
    refuse(path, "cannot be made (" + reason(failure) + ")",
           failure == EEXIST ? "an existing file is never overwritten: name another one"
                             : "check the path and the rights");
}

bool ensureKey(const std::string& path) {
  const auto isThere = [&path] {
    struct stat entry {};
    return ::lstat(path.c_str(), &entry) == 0;
  };
  if (isThere()) return false;
  try {
    writeNewKey(path);
    return true;
  } catch (const std::runtime_error&) {
    if (isThere()) return false;
    throw;
  }
}

std::string fingerprint(const SealKey& key) {
  requireSodium();
  constexpr const char* kLabel = "fingerprint of a key of Tread";
  uint8_t hash[16];
  crypto_generichash(hash, sizeof hash, reinterpret_cast<const uint8_t*>(kLabel),
                     std::char_traits<char>::length(kLabel), key.bytes.data(), key.bytes.size());
  char digits[17];
  sodium_bin2hex(digits, sizeof digits, hash, 8);
  const std::string text = digits;
  return text.substr(0, 4) + "-" + text.substr(4, 4) + "-" + text.substr(8, 4) + "-" +
         text.substr(12, 4);
}

std::optional<Sealer> hostSealer(const std::string& path) {
  if (path.empty()) return std::nullopt;
  return Sealer(readKey(path), newSender(), hostSession());
}

std::optional<Sealer> stationSealer(const std::string& path) {
  if (path.empty()) return std::nullopt;
  return Sealer(readKey(path), newSender(), std::nullopt);
}

}  // namespace tread
