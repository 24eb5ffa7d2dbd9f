// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/recordings/book_update.hpp"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "common/pattern/pattern_file.hpp"

namespace tread::recordings {
namespace {

namespace fs = std::filesystem;

/// What makes two sets different ones to execute, in words; empty if nothing.
std::string executedDifference(const PatternSet& book, const PatternSet& executed) {
  const PatternSetContent& there = book.content();
  const PatternSetContent& here = executed.content();
  if (there.kind != here.kind) return "another kind of command";
  if (there.period_us != here.period_us) return "another period";
  if (there.patterns.size() != here.patterns.size())
    return std::to_string(there.patterns.size()) + " patterns, not " +
           std::to_string(here.patterns.size());
  for (size_t p = 0; p < here.patterns.size(); ++p) {
    const MotionPattern& a = there.patterns[p];
    const MotionPattern& b = here.patterns[p];
    if (a.name != b.name) return "'" + a.name + "' in the place of '" + b.name + "'";
    if (a.commands != b.commands) return "other commands of '" + a.name + "'";
    if (a.entry_class != b.entry_class || a.exit_class != b.exit_class)
      return "other classes of '" + a.name + "'";
  }
  return "";
}

void requireSamePatterns(const std::string& folder, const PatternSet& executed) {
  const std::string path = (fs::path(folder) / "patterns.yaml").string();
  std::error_code failure;
  if (!fs::exists(path, failure)) return;
  std::string difference;
  try {
    difference = executedDifference(readPatternFile(path), executed);
  } catch (const std::exception& error) {
    throw RecordingError(error.what());
  }
  if (!difference.empty())
    throw RecordingError(path + ": this book is of another set (" + difference +
                         "); record into another folder");
}

}  // namespace

void requireSurfaceName(const std::string& name) {
  const bool bad = name.empty() || name.front() == '.' || name.find('/') != std::string::npos ||
                   std::any_of(name.begin(), name.end(), [](unsigned char c) { return c < ' '; });
  if (bad)
    throw RecordingError("surface '" + name + "': its name is that of its file; it must not be " +
                         "empty, begin with a dot or hold a slash");
}

void requireAddable(const std::string& folder, const PatternSet& executed,
                    const std::string& surface) {
  requireSurfaceName(surface);
  for (const MotionPattern& pattern : executed.patterns())
    if (pattern.name.find(',') != std::string::npos || pattern.name.front() == '#')
      throw RecordingError("pattern '" + pattern.name +
                           "' has a comma or a leading # in its name, which its table of " +
                           "recordings could not hold; rename it");
  requireSamePatterns(folder, executed);
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (!fs::is_directory(folder, failure) || ::access(folder.c_str(), W_OK | X_OK) != 0)
    throw RecordingError(folder + ": cannot be made or written to; check the name and rights");
}

bool addToBook(const std::string& folder, const PatternSet& executed,
               const SurfaceRecordings& surface) {
  requireAddable(folder, executed, surface.surface);
  std::error_code failure;
  const bool was_there = fs::exists(fs::path(folder) / (surface.surface + ".csv"), failure);
  const std::string patterns = (fs::path(folder) / "patterns.yaml").string();
  // Predictions may differ from the book's; the book keeps its own.
  const bool is_book = fs::exists(patterns, failure);
  writeBook(folder, {is_book ? readPatternFile(patterns) : executed, {surface}});
  return was_there;
}

}  // namespace tread::recordings
