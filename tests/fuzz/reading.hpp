// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Helpers shared by the targets.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <string>

#include <sys/mman.h>
#include <unistd.h>

#include "common/config/config_reader.hpp"
#include "common/pattern/pattern_file.hpp"

namespace tread::fuzz {

inline std::string textOf(const uint8_t* bytes, size_t size) {
  return {reinterpret_cast<const char*>(bytes), size};
}

/// Appends the fingerprint, so that the content is decoded.
inline std::string sealed(const uint8_t* bytes, size_t size) {
  uint64_t hash = 14695981039346656037ULL;
  for (size_t i = 0; i < size; ++i) hash = (hash ^ bytes[i]) * 1099511628211ULL;
  std::ostringstream end;
  end << "end " << std::hex << hash << '\n';
  return textOf(bytes, size) + end.str();
}

/// Reports a violated promise of a reader.
inline void require(bool kept) {
  if (!kept) std::abort();
}

/// A file of these bytes in memory.
class MemoryFile {
 public:
  MemoryFile(const uint8_t* bytes, size_t size) : descriptor_(memfd_create("fuzz", 0)) {
    require(descriptor_ >= 0 && write(descriptor_, bytes, size) == static_cast<ssize_t>(size));
  }
  ~MemoryFile() { close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

/// A named link to a MemoryFile, for readers that depend on the file name.
class NamedFile {
 public:
  NamedFile(const uint8_t* bytes, size_t size, const std::string& name)
      : file_(bytes, size),
        path_(std::filesystem::temp_directory_path() /
              ("tread-fuzz-" + std::to_string(getpid()) + name)) {
    std::filesystem::create_symlink(file_.path(), path_);
  }
  ~NamedFile() { unlink(path_.c_str()); }
  NamedFile(const NamedFile&) = delete;
  NamedFile& operator=(const NamedFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  MemoryFile file_;
  std::string path_;
};

/// A reader must refuse input with one line.
template <class Read>
void refusing(Read read) {
  try {
    read();
  } catch (const std::runtime_error& refusal) {
    require(refusal.what()[0] != '\0');
  }
}

template <class Read>
void configuration(const uint8_t* bytes, size_t size, Read read) {
  refusing([&] {
    ConfigReader reader = ConfigReader::fromText(textOf(bytes, size), "configuration");
    read(reader);
    reader.finish();
  });
}

/// The pattern set for reading the other files.
inline const PatternSet& shippedSet() {
  static const PatternSet shipped =
      readPatternFile(std::string(TREAD_SOURCE_DIR) + "/config/patterns/teodor.yaml");
  return shipped;
}

}  // namespace tread::fuzz
