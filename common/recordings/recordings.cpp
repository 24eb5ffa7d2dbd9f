// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/recordings/recordings.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>

#include "common/config/problem_words.hpp"
#include "common/config/scalars.hpp"
#include "common/pattern/pattern_file.hpp"
#include "common/store/output_file.hpp"
#include "common/store/store.hpp"

namespace tread::recordings {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPatterns = "patterns.yaml";
constexpr const char* kSurfaceHeader = "pattern,execution,sample,x_m,y_m,yaw_rad";

/// Collects the executions of a surface row by row.
class SurfaceReader {
 public:
  SurfaceReader(const CsvTable& table, const PatternSet& set)
      : table_(table), patterns_(set.patterns()), last_number_(patterns_.size(), 0) {
    table_.require({"pattern", "execution", "sample", "x_m", "y_m", "yaw_rad"});
    result_.executions.resize(patterns_.size());
  }

  SurfaceRecordings read() {
    for (row_ = 0; row_ < table_.rows(); ++row_) readRow();
    requireWhole();
    for (size_t p = 0; p < patterns_.size(); ++p)
      if (result_.executions[p].empty())
        throw error("pattern '" + patterns_[p].name +
                    "' of patterns.yaml has no execution here; record it or take it out there");
    return std::move(result_);
  }

 private:
  RecordingError error(const std::string& problem) const { return table_.error(row_, problem); }
  size_t wanted() const { return patterns_[pattern_].commands.size(); }
  Execution& poses() { return result_.executions[pattern_].back(); }
  const Execution& poses() const { return result_.executions[pattern_].back(); }

  void readRow() {
    const int execution = table_.integer(row_, "execution");
    const int sample = table_.integer(row_, "sample");
    if (open_ && table_.text(row_, "pattern") == patterns_[pattern_].name && execution == number_)
      requireNext(sample);
    else
      begin(execution, sample);
    poses().push_back(
        {table_.number(row_, "x_m"), table_.number(row_, "y_m"), table_.number(row_, "yaw_rad")});
  }

  void requireNext(int sample) const {
    const size_t have = poses().size();
    if (have == wanted())
      throw error("sample " + std::to_string(sample) + " of " + place() + ", which has " +
                  std::to_string(wanted()) + " commands; each command has one pose");
    if (sample != static_cast<int>(have) + 1)
      throw error("sample " + std::to_string(sample) + " of " + place() + " follows sample " +
                  std::to_string(have) + "; samples count up by 1");
  }

  void begin(int execution, int sample) {
    requireWhole();
    findPattern();
    int& last = last_number_[pattern_];
    number_ = execution;
    if (execution <= last)
      throw error(place() + (last == 0 ? "" : " after execution " + std::to_string(last)) +
                  "; executions of a pattern have rising numbers from 1 and stand together");
    if (sample != 1)
      throw error(place() + " begins with sample " + std::to_string(sample) +
                  "; samples count from 1");
    last = execution;
    open_ = true;
    result_.executions[pattern_].emplace_back().reserve(wanted());
  }

  /// Checks that the execution just read has all of its samples.
  void requireWhole() const {
    if (open_ && poses().size() != wanted())
      throw error(place() + " ends before this line with " + std::to_string(poses().size()) +
                  " of " + std::to_string(wanted()) +
                  " samples; take it out, or is the file truncated?");
  }

  void findPattern() {
    const std::string& name = table_.text(row_, "pattern");
    std::vector<std::string> known;
    for (size_t p = 0; p < patterns_.size(); ++p) {
      if (patterns_[p].name == name) {
        pattern_ = p;
        return;
      }
      known.push_back(patterns_[p].name);
    }
    throw error("pattern '" + name + "' is not in patterns.yaml; known are " + joinWords(known));
  }

  std::string place() const {
    return "execution " + std::to_string(number_) + " of pattern '" + patterns_[pattern_].name +
           "'";
  }

  const CsvTable& table_;
  const std::vector<MotionPattern>& patterns_;
  SurfaceRecordings result_;
  std::vector<int> last_number_;  ///< of the executions read, by pattern
  size_t row_ = 0;
  bool open_ = false;  ///< an execution has been begun
  size_t pattern_ = 0;
  int number_ = 0;
};

void appendExecution(std::string& text, const std::string& pattern, size_t number,
                     const Execution& poses) {
  for (size_t i = 0; i < poses.size(); ++i) {
    text += pattern + ',' + std::to_string(number) + ',' + std::to_string(i + 1);
    for (const double value : {poses[i].x, poses[i].y, poses[i].yaw})
      text += ',' + formatNumber(value);
    text += '\n';
  }
}

/// The files of the surfaces, sorted, so that their order is the same on every machine.
std::vector<fs::path> surfaceFiles(const std::string& folder) {
  std::vector<fs::path> files;
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(folder, failure))
    if (entry.path().extension() == ".csv" && entry.path().filename().string().front() != '.')
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

/// A surface's name is that of its file.
void requireSurfaceName(const std::string& name) {
  const bool bad = name.empty() || name.front() == '.' || name.find('/') != std::string::npos ||
                   std::any_of(name.begin(), name.end(), [](unsigned char c) { return c < ' '; });
  if (bad)
    throw RecordingError("surface '" + name + "': its name is that of its file; it must not be " +
                         "empty, begin with a dot or hold a slash");
}

void requirePatternName(const std::string& name) {
  if (name.find(',') != std::string::npos || name.front() == '#')
    throw RecordingError("pattern '" + name +
                         "' has a comma or a leading # in its name, which its table of " +
                         "recordings could not hold; rename it");
}

/// An existing file with the same set keeps its comments.
void writePatterns(const std::string& path, const PatternSet& patterns) {
  std::error_code failure;
  if (fs::exists(path, failure)) try {
      if (readPatternFile(path).checksum() == patterns.checksum()) return;
    } catch (const std::exception&) {
      // An unreadable file is replaced.
    }
  writeText(path, formatPatterns(patterns));
}

/// How two sets differ in what is executed, in words; empty if they do not.
std::string executedDifference(const PatternSet& recorded, const PatternSet& executed) {
  const PatternSetContent& there = recorded.content();
  const PatternSetContent& here = executed.content();
  if (there.channels != here.channels) return "another kind of command";
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

void requireSamePatterns(const std::string& path, const PatternSet& executed) try {
  std::error_code failure;
  if (!fs::exists(path, failure)) return;
  const std::string difference = executedDifference(readPatternFile(path), executed);
  if (!difference.empty())
    throw RecordingError(path + ": these recordings are of another set (" + difference +
                         "); record into another folder");
} catch (const std::exception& error) {
  throw RecordingError(wordsOf(error));
}

}  // namespace

void requireSamePatternCount(const SurfaceRecordings& surface, const PatternSet& set) {
  if (surface.executions.size() != set.patterns().size())
    throw RecordingError("surface '" + surface.surface + "': recordings of " +
                         std::to_string(surface.executions.size()) + " patterns, the set has " +
                         std::to_string(set.patterns().size()));
}

bool isWhole(const Execution& poses, size_t samples) {
  const auto finite = [](const Pose2& pose) {
    return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.yaw);
  };
  return poses.size() == samples && std::all_of(poses.begin(), poses.end(), finite);
}

void requireReadable(const SurfaceRecordings& surface, const PatternSet& set) {
  requireSurfaceName(surface.surface);
  requireSamePatternCount(surface, set);
  for (size_t p = 0; p < set.patterns().size(); ++p) {
    const MotionPattern& pattern = set.patterns()[p];
    const std::string place = "surface '" + surface.surface + "': pattern '" + pattern.name + "' ";
    requirePatternName(pattern.name);
    if (surface.executions[p].empty())
      throw RecordingError(place + "has no execution; record it or take it out of the set");
    for (size_t e = 0; e < surface.executions[p].size(); ++e)
      if (!isWhole(surface.executions[p][e], pattern.commands.size()))
        throw RecordingError(place + "execution " + std::to_string(e + 1) +
                             " is not one finite pose a command; leave it out");
  }
}

PatternRecordings readRecordings(const std::string& folder) try {
  std::error_code failure;
  if (!fs::is_directory(folder, failure))
    throw RecordingError(folder + ": no such folder; recordings are a folder with " +
                         "patterns.yaml and a SURFACE.csv for each surface");
  PatternRecordings recordings{readPatternFile((fs::path(folder) / kPatterns).string()), {}};
  for (const fs::path& file : surfaceFiles(folder))
    recordings.surfaces.push_back(parseSurface(readText(file.string()), file.string(),
                                               file.stem().string(), recordings.patterns));
  if (recordings.surfaces.empty())
    throw RecordingError(folder + ": no surface; each surface is a file SURFACE.csv with the " +
                         "header " + kSurfaceHeader);
  return recordings;
} catch (const std::exception& error) {
  throw RecordingError(wordsOf(error));
}

void writeRecordings(const std::string& folder, const PatternRecordings& recordings) try {
  for (const SurfaceRecordings& surface : recordings.surfaces)
    requireReadable(surface, recordings.patterns);
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (!fs::is_directory(folder, failure))
    throw RecordingError(folder + ": this folder cannot be made; check the name and rights");
  writePatterns((fs::path(folder) / kPatterns).string(), recordings.patterns);
  for (const SurfaceRecordings& surface : recordings.surfaces)
    writeText((fs::path(folder) / (surface.surface + ".csv")).string(),
              formatSurface(surface, recordings.patterns));
} catch (const WriteError&) {
  throw;
} catch (const std::exception& error) {
  throw RecordingError(wordsOf(error));
}

SurfaceRecordings parseSurface(const std::string& text, const std::string& path,
                               const std::string& surface, const PatternSet& patterns) {
  const CsvTable table(text, path);
  SurfaceRecordings recordings = SurfaceReader(table, patterns).read();
  recordings.surface = surface;
  return recordings;
}

std::string formatSurface(const SurfaceRecordings& recordings, const PatternSet& patterns) {
  std::string text = std::string(kSurfaceHeader) + '\n';
  for (size_t p = 0; p < patterns.patterns().size(); ++p)
    for (size_t e = 0; e < recordings.executions[p].size(); ++e)
      appendExecution(text, patterns.patterns()[p].name, e + 1, recordings.executions[p][e]);
  return text;
}

void requireAddable(const std::string& folder, const PatternSet& executed,
                    const std::string& surface) {
  requireSurfaceName(surface);
  for (const MotionPattern& pattern : executed.patterns()) requirePatternName(pattern.name);
  requireSamePatterns((fs::path(folder) / kPatterns).string(), executed);
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (!fs::is_directory(folder, failure) || ::access(folder.c_str(), W_OK | X_OK) != 0)
    throw RecordingError(folder + ": cannot be made or written to (" +
                         std::generic_category().message(errno) + "); check the name and rights");
}

bool addSurface(const std::string& folder, const PatternSet& executed,
                const SurfaceRecordings& surface) {
  requireAddable(folder, executed, surface.surface);
  std::error_code failure;
  const bool was_there = fs::exists(fs::path(folder) / (surface.surface + ".csv"), failure);
  // Predictions may differ from those of the recordings, which are kept.
  const std::string patterns = (fs::path(folder) / kPatterns).string();
  const bool has_patterns = fs::exists(patterns, failure);
  writeRecordings(folder, {has_patterns ? readPatternFile(patterns) : executed, {surface}});
  return was_there;
}

}  // namespace tread::recordings
