// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The sources as text: files, includes, types.
#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include "tests/helpers.hpp"

namespace tread::testing {

namespace fs = std::filesystem;

inline std::vector<fs::path> sourcesUnder(const std::string& folder) {
  std::vector<fs::path> files;
  const fs::path root = fs::path(TREAD_SOURCE_DIR) / folder;
  if (!fs::exists(root)) return files;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".hpp" || extension == ".cpp") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

inline bool startsWith(const std::string& text, const std::string& prefix) {
  return text.compare(0, prefix.size(), prefix) == 0;
}

/// The first `parts` components of a path: modules/planner for
/// modules/planner/core/search/pattern_search.hpp.
inline std::string head(const std::string& path, int parts) {
  size_t end = 0;
  for (int i = 0; i < parts && end != std::string::npos; ++i) end = path.find('/', end + 1);
  return path.substr(0, end);
}

inline std::vector<std::string> foldersOf(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(fs::path(TREAD_SOURCE_DIR) / folder))
    if (entry.is_directory()) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// The end of the comment, literal or preprocessor line that begins at `at`; else `at`.
inline size_t skipped(const std::string& text, size_t at) {
  const auto past = [&](const std::string& end, size_t from) {
    const size_t found = text.find(end, from);
    return found == std::string::npos ? text.size() : found + end.size();
  };
  if (text.compare(at, 2, "//") == 0) return past("\n", at) - 1;
  if (text.compare(at, 2, "/*") == 0) return past("*/", at + 2);
  if (text.compare(at, 2, "R\"") == 0) {
    const size_t open = text.find('(', at);
    return past(")" + text.substr(at + 2, open - at - 2) + "\"", open);
  }
  const bool in_word = at > 0 && std::isalnum(static_cast<unsigned char>(text[at - 1])) != 0;
  if (text[at] == '"' || (text[at] == '\'' && !in_word)) {
    size_t end = at + 1;
    while (end < text.size() && text[end] != text[at]) end += text[end] == '\\' ? 2 : 1;
    return end + 1;
  }
  const size_t before = at == 0 ? std::string::npos : text.find_last_not_of(" \t", at - 1);
  if (text[at] == '#' && (before == std::string::npos || text[before] == '\n')) {
    size_t end = text.find('\n', at);
    while (end != std::string::npos && text[end - 1] == '\\') end = text.find('\n', end + 1);
    return std::min(end, text.size());
  }
  return at;
}

/// The text without comments, literals and preprocessor lines.
inline std::string codeOf(const std::string& text) {
  std::string code;
  for (size_t at = 0; at < text.size();) {
    const size_t end = skipped(text, at);
    code += end == at ? text[at] : ' ';
    at = end == at ? at + 1 : end;
  }
  return code;
}

/// Names of the types that a source defines in a named namespace, with the namespace.
inline std::vector<std::string> typesIn(const std::string& text) {
  static const std::regex kNamespace(R"re((?:inline\s+)?namespace(?:\s+([\w:]+))?\s*)re");
  static const std::regex kType(
      R"re((?:template\s*<[^{}]*>\s*)?(?:struct|class|union|enum(?:\s+(?:class|struct))?)\s+(?:\w+\s*\([^)]*\)\s*)?(\w+)(?:\s+final)?\s*(?::[^:][^]*)?)re");
  std::vector<std::string> types;
  std::vector<std::string> scopes;  // of each open brace: its namespace, "" if it is none
  std::string head;                 // what stands before a brace
  for (const char c : codeOf(text)) {
    if (c != '{' && c != '}' && c != ';') {
      if (!head.empty() || !std::isspace(static_cast<unsigned char>(c))) head += c;
      continue;
    }
    if (c == '}' && !scopes.empty()) scopes.pop_back();
    if (c == '{') {
      std::smatch match;
      std::string scope;
      for (const std::string& part : scopes) scope += part.empty() ? "{}" : part + "::";
      const bool named = scope.find("{}") == std::string::npos;
      if (head.find("namespace") != head.npos && std::regex_match(head, match, kNamespace)) {
        scopes.push_back(match[1]);
      } else {
        if (named && std::regex_match(head, match, kType)) types.push_back(scope + match[1].str());
        scopes.emplace_back();
      }
    }
    head.clear();
  }
  return types;
}

}  // namespace tread::testing
