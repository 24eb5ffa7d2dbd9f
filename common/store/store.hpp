// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tread {

/// Named entries of state that outlive a process. Writing is atomic: after a crash either the old
/// or the new entry is there, whole.
class Store {
 public:
  virtual ~Store() = default;

  /// Content of an entry; nullopt if there is none.
  virtual std::optional<std::string> read(const std::string& name) const = 0;
  /// Replaces an entry. Returns one clear line if it cannot be written (disk full, no permission),
  /// else nullopt.
  virtual std::optional<std::string> write(const std::string& name, const std::string& content) = 0;
  /// Removes an entry if it exists.
  virtual void remove(const std::string& name) = 0;
  /// Names of the entries, sorted.
  virtual std::vector<std::string> names() const = 0;
};

/// Each entry is a file of a folder, written as OutputFile does.
class FileStore : public Store {
 public:
  /// Creates the folder if needed; throws std::runtime_error if that fails, or if another process
  /// uses it.
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
  /// Makes all writes fail with this message, as on a full disk; empty = writes work again.
  void failWith(const std::string& problem) { problem_ = problem; }

 private:
  std::map<std::string, std::string> entries_;
  std::string problem_;
};

// Text files named by users.

/// The whole text of a file; throws std::runtime_error with one line that contains its name.
std::string readText(const std::string& path);

/// Writes a file whole or not at all, as OutputFile does; throws WriteError with one line.
void writeText(const std::string& path, const std::string& text);

}  // namespace tread
