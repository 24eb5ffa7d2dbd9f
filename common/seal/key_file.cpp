// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/seal/key_file.hpp"

#include <sodium.h>

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "common/seal/private_file.hpp"

namespace tread {
namespace {

constexpr const char* kComment =
    "# A key of Tread: anybody who can read this file can drive the robot. Made by tread-key "
    "new.\n";

PrivateFile keyFile(const std::string& path) {
  return {"key", path, "make one with tread-key new"};
}

/// Whether the line is a key; if so, reads it.
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

std::string newKeyText() {
  requireSodium();
  SealKey key;
  randombytes_buf(key.bytes.data(), key.bytes.size());
  char digits[2 * sizeof key.bytes + 1];
  sodium_bin2hex(digits, sizeof digits, key.bytes.data(), key.bytes.size());
  return kComment + std::string(digits) + "\n";
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
  std::istringstream lines(keyFile(path).read());
  SealKey key;
  int keys = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line.front() == '#') continue;
    if (++keys > 1 || !isKey(line, key)) keys = 2;
  }
  if (keys != 1)
    // Neither tread-key nor a start ever overwrites an existing file.
    keyFile(path).refuse("holds no key (one line of 64 hexadecimal digits), or only a part of one",
                         "remove it, then make one with tread-key new " + path);
  return key;
}

void writeNewKey(const std::string& path) {
  keyFile(path).make(newKeyText());
}

bool ensureKey(const std::string& path) {
  return keyFile(path).ensure(newKeyText());
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
