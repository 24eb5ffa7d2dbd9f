// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdio>
#include <memory>
#include <string>

namespace tread {

/// A file to be read that may be packed by gzip: it is then unpacked to a temporary file without a
/// name, which goes with this object.
/** Files that xz, bzip2, zstd or zip packed are refused by name, in one line with the command that
 * unpacks them (std::runtime_error). A file that cannot be opened is left to its reader. */
class UnpackedFile {
 public:
  explicit UnpackedFile(const std::string& name);

  /// What can be read.
  const std::string& path() const { return path_; }
  /// One clear line if the packed file is damaged or cut off; what stands before that was unpacked.
  const std::string& problem() const { return problem_; }
  /// A message about the unpacked file, with the name of the packed one.
  std::string named(std::string message) const;
  /// The same where reading failed: damage of the packed file comes before what follows from it.
  std::string reasonOf(const std::string& failure) const;

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void unpack();

  std::string name_, path_, problem_;
  std::unique_ptr<std::FILE, Close> file_;
};

/// What packed a file, by its first bytes: "gzip", "xz", "bzip2", "zstd", "zip"; empty = nothing.
std::string packingOf(const std::string& path);

}  // namespace tread
