// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/hide/case_folder.hpp"

#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace fs = std::filesystem;

namespace tread::blind {
namespace {

void requireNew(const fs::path& path) {
  if (fs::exists(path))
    throw std::runtime_error(path.string() + ": exists already; give another --name or folder");
}

/// Writes a log, and truncates it if the case demands it.
void writeLog(const fs::path& path, const MadeCase& made) {
  LogWriter writer(path.string());
  for (const LogEvent& event : made.events)
    writer.write(event.utime, event.channel, event.bytes.data(), event.bytes.size());
  writer.close();
  if (made.keep < 1.0)
    fs::resize_file(path,
                    static_cast<uintmax_t>(made.keep * static_cast<double>(fs::file_size(path))));
}

}  // namespace

void writeCase(const std::string& folder, const std::string& name, const MadeCase& made) {
  const fs::path log = fs::path(folder) / "blind" / (name + ".lcm");
  const fs::path truth = fs::path(folder) / "truth" / (name + ".json");
  for (const fs::path& path : {log, truth}) {
    fs::create_directories(path.parent_path());
    requireNew(path);
  }
  std::ofstream file(truth, std::ios::binary);
  file << made.truth << std::flush;
  if (!file) throw std::runtime_error(truth.string() + ": cannot be written");
  writeLog(log, made);
}

}  // namespace tread::blind
