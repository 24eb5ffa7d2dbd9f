// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/recordings/recordings.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>

#include "common/pattern/pattern_file.hpp"
#include "common/recordings/book_update.hpp"
#include "common/recordings/surface_csv.hpp"
#include "common/recordings/text_file.hpp"

namespace tread::recordings {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPatterns = "patterns.yaml";

std::string pathIn(const std::string& folder, const std::string& name) {
  return (fs::path(folder) / name).string();
}

/// The files of the surfaces, sorted, so that a book is the same on every machine.
std::vector<fs::path> surfaceFiles(const std::string& folder) {
  std::vector<fs::path> files;
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(folder, failure))
    if (entry.path().extension() == ".csv" && entry.path().filename().string().front() != '.')
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

bool isWhole(const Execution& poses, size_t samples) {
  const auto finite = [](const Pose2& pose) {
    return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.yaw);
  };
  return poses.size() == samples && std::all_of(poses.begin(), poses.end(), finite);
}

/// Refuses what readBook() would refuse, before anything is written.
void requireReadable(const SurfaceRecordings& surface, const PatternSet& set) {
  requireSurfaceName(surface.surface);
  const std::vector<MotionPattern>& patterns = set.patterns();
  const std::string place = "surface '" + surface.surface + "': ";
  if (surface.executions.size() != patterns.size())
    throw RecordingError(place + "recordings of " + std::to_string(surface.executions.size()) +
                         " patterns, the set has " + std::to_string(patterns.size()));
  for (size_t p = 0; p < patterns.size(); ++p) {
    const std::string pattern = place + "pattern '" + patterns[p].name + "' ";
    if (patterns[p].name.find(',') != std::string::npos || patterns[p].name.front() == '#')
      throw RecordingError(pattern + "has a comma or a leading # in its name; rename it");
    if (surface.executions[p].empty())
      throw RecordingError(pattern + "has no execution; record it or take it out of the set");
    for (size_t e = 0; e < surface.executions[p].size(); ++e)
      if (!isWhole(surface.executions[p][e], patterns[p].commands.size()))
        throw RecordingError(pattern + "execution " + std::to_string(e + 1) +
                             " is not one finite pose a command; leave it out");
  }
}

/// A file that holds the same set already keeps the comments that people wrote into it.
void writePatterns(const std::string& path, const PatternSet& patterns) {
  std::error_code failure;
  if (fs::exists(path, failure)) try {
      if (readPatternFile(path).checksum() == patterns.checksum()) return;
    } catch (const std::exception&) {
      // What cannot be read is replaced.
    }
  writeText(path, formatPatterns(patterns));
}

}  // namespace

RecordingBook readBook(const std::string& folder) try {
  std::error_code failure;
  if (!fs::is_directory(folder, failure))
    throw RecordingError(folder + ": no such folder; a book of recordings is a folder with " +
                         "patterns.yaml and a SURFACE.csv for each surface");
  RecordingBook book{readPatternFile(pathIn(folder, kPatterns)), {}};
  for (const fs::path& file : surfaceFiles(folder))
    book.surfaces.push_back(
        parseSurface(readText(file.string()), file.string(), file.stem().string(), book.patterns));
  if (book.surfaces.empty())
    throw RecordingError(folder + ": no surface; each surface is a file SURFACE.csv with the " +
                         "header " + kSurfaceHeader);
  return book;
} catch (const RecordingError&) {
  throw;
} catch (const std::exception& error) {
  throw RecordingError(error.what());
}

void writeBook(const std::string& folder, const RecordingBook& book) try {
  for (const SurfaceRecordings& surface : book.surfaces) requireReadable(surface, book.patterns);
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (!fs::is_directory(folder, failure))
    throw RecordingError(folder + ": this folder cannot be made; check the name and rights");
  writePatterns(pathIn(folder, kPatterns), book.patterns);
  for (const SurfaceRecordings& surface : book.surfaces)
    writeText(pathIn(folder, surface.surface + ".csv"), formatSurface(surface, book.patterns));
} catch (const RecordingError&) {
  throw;
} catch (const std::exception& error) {
  throw RecordingError(error.what());
}

}  // namespace tread::recordings
