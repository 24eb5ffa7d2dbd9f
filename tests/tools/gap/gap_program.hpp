// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <catch2/catch.hpp>

namespace tread::gap::samples {

/// Exit status and what a command line printed, errors included.
struct Run {
  int status = -1;
  std::string printed;

  bool says(const std::string& words) const { return printed.find(words) != std::string::npos; }
};

/// A program of the house, called as people call it.
inline Run runProgram(const std::string& program, const std::string& arguments) {
  const std::string command =
      std::string(TREAD_BIN_DIR) + "/" + program + " " + arguments + " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  Run result;
  std::array<char, 512> buffer{};
  while (fgets(buffer.data(), static_cast<int>(buffer.size()), pipe) != nullptr)
    result.printed += buffer.data();
  result.status = WEXITSTATUS(pclose(pipe));
  return result;
}

inline Run run(const std::string& arguments) {
  return runProgram("tread-gap", arguments);
}

/// A folder of this test that is gone afterwards.
class Folder {
 public:
  Folder() {
    static int count = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("tread-gap-" + std::to_string(getpid()) + "-" + std::to_string(++count));
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::string path(const std::string& name) const { return (path_ / name).string(); }
  std::string text(const std::string& name) const {
    std::ifstream file(path_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
  }

 private:
  std::filesystem::path path_;
};

inline const std::string kModels = std::string(TREAD_SOURCE_DIR) + "/config/models/";

}  // namespace tread::gap::samples
