// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tread {

/// Named pieces of state that outlive a process. Writing is atomic: after a crash the old or the
/// new is there, whole.
class Store {
 public:
  virtual ~Store() = default;

  /// Content of an entry, or nothing.
  virtual std::optional<std::string> read(const std::string& name) const = 0;
  /// Replaces an entry. Returns one clear line if it could not be written (disk full, no
  /// permission), else nothing.
  virtual std::optional<std::string> write(const std::string& name, const std::string& content) = 0;
  /// Removes an entry if it exists.
  virtual void remove(const std::string& name) = 0;
  /// Names of the entries, sorted.
  virtual std::vector<std::string> names() const = 0;
};

/// Entries are files of a folder: written to a temporary file, flushed to disk, renamed.
class FileStore : public Store {
 public:
  /// Creates the folder if needed; throws std::runtime_error if that fails, or where another
  /// process uses it.
  explicit FileStore(std::string folder);
  ~FileStore() override;
  FileStore(const FileStore&) = delete;
  FileStore& operator=(const FileStore&) = delete;

  std::optional<std::string> read(const std::string& name) const override;
  std::optional<std::string> write(const std::string& name, const std::string& content) override;
  void remove(const std::string& name) override;
  std::vector<std::string> names() const override;

 private:
  std::string folder_;
  int lock_ = -1;  ///< the folder, locked
};

/// Entries in memory; for virtual time. Outlives the nodes that use it.
class MemoryStore : public Store {
 public:
  std::optional<std::string> read(const std::string& name) const override;
  std::optional<std::string> write(const std::string& name, const std::string& content) override;
  void remove(const std::string& name) override;
  std::vector<std::string> names() const override;
  /// From now on writing fails with this line, as on a full disk; empty = works again.
  void failWith(const std::string& problem) { problem_ = problem; }

 private:
  std::map<std::string, std::string> entries_;
  std::string problem_;
};

// Text files that people name.

/// The whole text of a file; throws std::runtime_error with one line that names it.
std::string readText(const std::string& path);

/// Writes a file whole or not at all: a reader finds the old text or the new one.
/** What is no regular file, /dev/stdout for instance, is written to as it stands. Throws
 * std::runtime_error with one line that names the file. */
void writeText(const std::string& path, const std::string& text);

/// Throws as writeText() would where it is known before that a file cannot be written: for those
/// who work long before they write.
void requireWritable(const std::string& path);

/// Throws std::runtime_error if an output would replace one of the inputs, by whatever name.
void refuseToReplace(const std::string& output, const std::vector<std::string>& inputs);

/// Before the work: throws with one line if an output, of which empty ones are none, would replace
/// an input or another output, or cannot be written.
void checkOutputs(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs);

/// Writes a file whole or not at all, over what is there, but never over one of the inputs; throws
/// std::runtime_error with one line.
void writeOutput(const std::string& path, const std::string& text,
                 const std::vector<std::string>& inputs);

}  // namespace tread
