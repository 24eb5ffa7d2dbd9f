// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace tread {

/// A file cannot be written: no permission, or the disk is full. Programs then exit with code 1.
class WriteError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The only way in which our programs write a file.
/** The bytes go to PATH.PID.unfinished beside it. commit() waits until they are on the disk and
 * renames it to PATH: if anything fails before (full disk, exception, kill -9), the old file stays
 * unchanged. A symlink is kept, and so are owner and rights. A PATH that is no regular file (a
 * pipe, /dev/stdout) is written directly. All functions throw WriteError with one line. */
class OutputFile {
 public:
  enum class Kind {
    kWhole,    ///< as above
    kGrowing,  ///< a new file under its final name from its first byte, for live recording: flushed
               ///< data survive a crash; it never opens an existing file
  };

  explicit OutputFile(const std::string& path, Kind kind = Kind::kWhole);
  /// Removes an uncommitted file, unless it is kGrowing.
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(const void* bytes, size_t size);
  void write(const std::string& text) { write(text.data(), text.size()); }
  /// Flushes the buffer.
  void flush();
  void commit();

 private:
  void open(Kind kind);
  void openTemporary();
  void writeOut(const void* bytes, size_t size);
  [[noreturn]] void fail(const char* what);

  std::string path_;    ///< as it was named
  std::string target_;  ///< where it leads
  std::string temporary_;
  std::string buffer_;
  int fd_ = -1;
  int error_ = 0;  ///< of the first failure; the buffer was lost then, so the file stays failed
};

/// A folder whose files are moved to their final places together, after all of them are written.
/** They are written in path(), a subfolder, by any means; commit() moves them up, in the order of
 * their names, over existing files of the same names. Other files of the folder stay. */
class OutputFolder {
 public:
  /// Creates the folder if needed.
  explicit OutputFolder(const std::string& folder);
  /// Removes uncommitted files.
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  const std::string& path() const { return temporary_; }
  void commit();

 private:
  std::string folder_;
  std::string temporary_;
  bool made_ = false;
};

/// Waits until a folder's entries are on the disk: otherwise a power failure may undo a rename. A
/// folder that cannot be read or synced is no failure.
void syncFolder(const std::string& folder);

/// Frees a name for a new recording: an existing file is renamed to PATH.1, or the next free
/// number.
void moveAside(const std::string& path);

/// Whether this is the name of a file that a killed program left behind.
bool isUnfinished(const std::string& name);

/// A file or folder that a program will write.
struct PlannedOutput {
  enum class Kind { kFile, kFolder, kEither };
  std::string path;  ///< empty = none
  Kind kind = Kind::kFile;
};

/// Call before the work; opens nothing. Throws std::runtime_error with one line if an output is an
/// input (by whatever name) or lies in an input folder, if two outputs are the same, if one exists
/// (unless `replace`), or if it cannot be written. An existing empty folder is allowed.
void checkOutputs(const std::vector<PlannedOutput>& outputs, const std::vector<std::string>& inputs,
                  bool replace);

/// Throws std::runtime_error with one line if an output is one of the inputs, by whatever name.
void refuseToReplace(const std::string& output, const std::vector<std::string>& inputs);

}  // namespace tread
