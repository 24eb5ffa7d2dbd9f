// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/hide/sealed_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>

#include "common/report/hash.hpp"

namespace fs = std::filesystem;

namespace tread::blind {
namespace {

std::string contentOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path.string() + ": cannot be read");
  return {std::istreambuf_iterator<char>(file), {}};
}

void writeNew(const fs::path& path, const std::string& text) {
  if (fs::exists(path))
    throw std::runtime_error(path.string() + ": exists already; give another --name or folder");
  std::ofstream file(path, std::ios::binary);
  file << text << std::flush;
  if (!file) throw std::runtime_error(path.string() + ": cannot be written");
}

/// Writes a log beside its place and cuts what a truncated one lacks.
void writeLog(const fs::path& path, const MadeCase& made) {
  {
    LogWriter writer(path.string());
    for (const LogEvent& event : made.events)
      writer.write(event.utime, event.channel, event.bytes.data(), event.bytes.size());
    writer.flush();
  }
  if (made.keep >= 1.0) return;
  const auto size = static_cast<double>(fs::file_size(path));
  fs::resize_file(path, static_cast<uintmax_t>(made.keep * size));
}

bool isList(const fs::path& path) {
  return path.filename().string().rfind("commitments", 0) == 0;
}

/// Lines "HASH  FILE" of all lists, by file.
std::map<std::string, std::string> committed(const fs::path& blind) {
  std::map<std::string, std::string> hashes;
  for (const auto& entry : fs::directory_iterator(blind)) {
    if (!isList(entry.path())) continue;
    std::istringstream lines(contentOf(entry.path()));
    std::string hash, file;
    while (lines >> hash >> file) hashes[file] = hash;
  }
  return hashes;
}

}  // namespace

SealedFolder::SealedFolder(const std::string& path, const std::string& part)
    : path_(path), list_(path + "/blind/commitments" + (part.empty() ? "" : "." + part) + ".txt") {
  fs::create_directories(fs::path(path) / "blind");
  fs::create_directories(fs::path(path) / "sealed");
  fs::permissions(fs::path(path) / "sealed", fs::perms::owner_all);
}

SealedFolder::~SealedFolder() {
  std::error_code ignored;
  fs::permissions(fs::path(path_) / "sealed", fs::perms::none, ignored);
}

void SealedFolder::commit(const std::string& line) {
  std::ofstream file(list_, std::ios::app);
  file << line << "\n" << std::flush;
  if (!file) throw std::runtime_error(list_ + ": cannot be written");
}

void SealedFolder::add(const std::string& name, const MadeCase& made) {
  const fs::path folder(path_);
  const fs::path log = folder / "blind" / (name + ".lcm");
  if (fs::exists(log)) throw std::runtime_error(log.string() + ": exists already");
  writeNew(folder / "sealed" / (name + ".json"), made.truth);
  commit(sha256(made.truth) + "  sealed/" + name + ".json");
  const fs::path hidden = folder / "sealed" / (name + ".part");
  writeLog(hidden, made);
  commit(sha256(contentOf(hidden)) + "  blind/" + name + ".lcm");
  fs::rename(hidden, log);
}

void mergeCommitments(const std::string& path) {
  const fs::path blind = fs::path(path) / "blind";
  // Each truth before its log, as a whole run writes them.
  std::map<std::pair<std::string, bool>, std::string> lines;
  for (const auto& [file, hash] : committed(blind)) {
    std::string& line = lines[{fs::path(file).stem().string(), file[0] != 's'}];
    line = hash;
    line.append("  ").append(file).append("\n");
  }
  std::vector<fs::path> lists;
  for (const auto& entry : fs::directory_iterator(blind))
    if (isList(entry.path())) lists.push_back(entry.path());
  std::string text;
  for (const auto& line : lines) text += line.second;
  for (const fs::path& list : lists) fs::remove(list);
  writeNew(blind / "commitments.txt", text);
}

std::vector<std::string> unseal(const std::string& path) {
  const fs::path folder(path);
  fs::permissions(folder / "sealed", fs::perms::owner_all);
  std::vector<std::string> wrong;
  const auto hashes = committed(folder / "blind");
  for (const auto& [file, hash] : hashes) {
    if (!fs::exists(folder / file)) {
      wrong.push_back(file + ": is missing");
    } else if (sha256(contentOf(folder / file)) != hash) {
      wrong.push_back(file + ": is not what was committed");
    }
  }
  for (const char* part : {"sealed", "blind"})
    for (const auto& entry : fs::directory_iterator(folder / part)) {
      const std::string file = part + ("/" + entry.path().filename().string());
      if (!isList(entry.path()) && hashes.count(file) == 0)
        wrong.push_back(file + ": was never committed");
    }
  return wrong;
}

}  // namespace tread::blind
