// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace tread {

/// The files that a command writes: one option each, and --force for all of them.
/** checkOutputs() checks them once the command line is read, before anything is opened; every other
 * argument that names a file or folder counts as an input. A refusal ends the program with one
 * line and kBadInput. Uses the command's parse_complete_callback. */
class Outputs {
 public:
  explicit Outputs(CLI::App& command);

  /// `path` must outlive the parsing, as with CLI::App::add_option.
  CLI::Option* file(const std::string& names, std::string& path, const std::string& what);
  /// A folder that is made if needed.
  CLI::Option* folder(const std::string& names, std::string& path, const std::string& what);
  CLI::Option* fileOrFolder(const std::string& names, std::string& path, const std::string& what);
  /// Files whose names follow from other options; evaluated once all options are known.
  void derived(std::function<std::vector<std::string>()> paths);

 private:
  struct Declared;
  CLI::App& command_;
  std::shared_ptr<Declared> declared_;
};

}  // namespace tread
