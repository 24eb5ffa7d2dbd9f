// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace tread {

/// The files that a command writes: an option each, and --force for all of them.
/** Once the command line is read, before anything is opened, checkOutputs() looks at them; every
 * other argument that names a file or a folder counts as an input. What is refused ends the program
 * with one line and kBadInput. It takes the command's parse_complete_callback. */
class Outputs {
 public:
  explicit Outputs(CLI::App& command);

  /// `path` must outlive the parsing, as with CLI::App::add_option.
  CLI::Option* file(const std::string& names, std::string& path, const std::string& what);
  /// A folder that is made if needed.
  CLI::Option* folder(const std::string& names, std::string& path, const std::string& what);
  CLI::Option* fileOrFolder(const std::string& names, std::string& path, const std::string& what);
  /// Files that other options name together; asked once all options are known.
  void derived(std::function<std::vector<std::string>()> paths);

 private:
  struct Declared;
  CLI::App& command_;
  std::shared_ptr<Declared> declared_;
};

}  // namespace tread
