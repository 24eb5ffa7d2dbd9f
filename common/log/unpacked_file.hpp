// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdio>
#include <memory>
#include <string>

namespace tread {

/// An input file that may be packed by gzip: it is then unpacked to an unnamed temporary file,
/// which is removed with this object.
/** Files packed by xz, bzip2, zstd or zip are refused with one line that gives the command to
 * unpack them (std::runtime_error). A file that cannot be opened is left to its reader. */
class UnpackedFile {
 public:
  explicit UnpackedFile(const std::string& name);

  /// What can be read.
  const std::string& path() const { return path_; }
  /// One clear line if the packed file is damaged or cut off; the intact part was unpacked.
  const std::string& problem() const { return problem_; }
  /// A message about the unpacked file, naming the packed one instead.
  std::string named(std::string message) const;
  /// Reason of a failed read: damage of the packed file takes precedence over its consequences.
  std::string reasonOf(const std::string& failure) const;

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void unpack();

  std::string name_, path_, problem_;
  std::unique_ptr<std::FILE, Close> file_;
};

/// How a file is packed, by its first bytes: "gzip", "xz", "bzip2", "zstd", "zip"; empty = not
/// packed.
std::string packingOf(const std::string& path);

}  // namespace tread
