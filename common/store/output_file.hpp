// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace tread {

/// A file that cannot be written: no rights, or the disk is full. Programs end with 1 of it.
class WriteError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The only way in which our programs write a file.
/** The bytes go to PATH.PID.unfinished beside it. commit() waits until they are on the disk and
 * moves them to PATH: whatever happens before, a full disk, an exception, kill -9, what was there
 * stays as it was. A link stays, and so do owner and rights. What is no regular file (a pipe,
 * /dev/stdout) is written to as it stands. All throw WriteError with one line. */
class OutputFile {
 public:
  enum class Kind {
    kWhole,    ///< as above
    kGrowing,  ///< a new file under its own name from its first byte, for what is recorded live:
               ///< what was flushed survives a crash; it never opens a file that is there
  };

  explicit OutputFile(const std::string& path, Kind kind = Kind::kWhole);
  /// Removes what was not committed, unless it grows.
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(const void* bytes, size_t size);
  void write(const std::string& text) { write(text.data(), text.size()); }
  /// Hands over what is buffered.
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
  int error_ = 0;  ///< of the first failure; what was buffered then is lost, so it stays failed
};

/// A folder whose files are put in their places together, once all of them are written.
/** They are written in path(), a folder in it, by whatever means; commit() moves them up, in the
 * order of their names, over those of the same names. Other files of the folder stay. */
class OutputFolder {
 public:
  /// Makes the folder, if it is not there.
  explicit OutputFolder(const std::string& folder);
  /// Removes what was not committed.
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

/// Waits until the names of a folder are on the disk: without it a rename may be lost with the
/// power. A folder that may not be read or cannot do it is no failure.
void syncFolder(const std::string& folder);

/// Makes a name free for what is recorded anew: what is there becomes PATH.1, or the next free one.
void moveAside(const std::string& path);

/// Whether this is the name of what a killed program left behind.
bool isUnfinished(const std::string& name);

/// What a program is about to write.
struct PlannedOutput {
  enum class Kind { kFile, kFolder, kEither };
  std::string path;  ///< empty = none
  Kind kind = Kind::kFile;
};

/// Before the work, with nothing opened: throws std::runtime_error with one line if an output is an
/// input, by whatever name, or lies in a folder that is one; if two are the same; if it is there
/// already, unless `replace`; and if it could not be written. A folder may be there if it is empty.
void checkOutputs(const std::vector<PlannedOutput>& outputs, const std::vector<std::string>& inputs,
                  bool replace);

/// Throws std::runtime_error with one line if an output is one of the inputs, by whatever name.
void refuseToReplace(const std::string& output, const std::vector<std::string>& inputs);

}  // namespace tread
