// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <string>
#include <vector>

namespace tread {

/// A file's name and text, shared by all its levels.
struct ConfigSource {
  ConfigSource(std::string file_name, std::string file_text);
  /// Offset of a mark in the text; columns count bytes.
  size_t offsetOf(const YAML::Mark& mark) const;
  /// Appends the lines of one override; returns the number (1-based) of the first.
  int append(const std::string& lines, const std::string& override_words);
  /// Where a line is, for messages: file:line, or the override that it came from.
  std::string place(int line) const;
  /// Whether a line (1-based) came from an override, not from the file.
  bool isOverride(int line) const { return file_lines > 0 && line > file_lines; }

  std::string name;
  std::string text;
  std::vector<size_t> line_starts;
  int file_lines = 0;                    ///< 0 = no override yet
  std::map<int, std::string> overrides;  ///< by their last line
};

/// The only document of a YAML text; null for an empty text.
/** Throws ConfigError with name:line for bad syntax and for a second document. */
YAML::Node loadOneDocument(const std::string& text, const std::string& name);

/// Applies "key=value" or "section.key=value" to the tree of a file; throws ConfigError.
void applyOverride(ConfigSource& source, const std::string& words, YAML::Node& root);

}  // namespace tread
