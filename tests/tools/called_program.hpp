// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <catch2/catch.hpp>

namespace tread::samples {

/// Exit status and output of a program, errors included.
struct CalledProgram {
  int status = -1;
  std::string printed;

  bool says(const std::string& words) const { return printed.find(words) != std::string::npos; }
  bool isOneLine() const { return !printed.empty() && printed.find('\n') == printed.size() - 1; }
};

/// A program of the build, run by a command line: "tread-report drive.lcmlog"; prefixed by
/// `through`, for instance "timeout 5".
inline CalledProgram called(const std::string& command_line, const std::string& through = "") {
  const std::string command = through + " " + TREAD_BIN_DIR + "/" + command_line + " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  CalledProgram result;
  std::array<char, 512> buffer{};
  while (fgets(buffer.data(), static_cast<int>(buffer.size()), pipe) != nullptr)
    result.printed += buffer.data();
  result.status = WEXITSTATUS(pclose(pipe));
  return result;
}

/// A temporary folder.
class OwnFolder {
 public:
  OwnFolder() {
    // A killed test may have left a folder named after any pid.
    std::string name = (std::filesystem::temp_directory_path() / "tread-tools-XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~OwnFolder() { std::filesystem::remove_all(path_); }
  OwnFolder(const OwnFolder&) = delete;
  OwnFolder& operator=(const OwnFolder&) = delete;

  std::string path(const std::string& name) const { return (path_ / name).string(); }
  std::string text(const std::string& name) const {
    std::ifstream file(path_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  /// Writes a file and returns its path.
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path(name);
  }

 private:
  std::filesystem::path path_;
};

inline bool isPng(const std::string& bytes) {
  return bytes.size() > 1000 && bytes.compare(0, 8, "\x89PNG\r\n\x1a\n") == 0;
}

}  // namespace tread::samples
