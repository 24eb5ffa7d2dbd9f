// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "modules/identification/core/drive.hpp"

namespace tread::gap {

/// Notes about one log, in the order in which they were made.
class NoteBook {
 public:
  explicit NoteBook(std::string log) : log_(std::move(log)) {}

  /// Nothing can be concluded from the log.
  void fatal(const std::string& what) { notes_.push_back({log_, what, true}); }
  void note(const std::string& what) { notes_.push_back({log_, what, false}); }
  std::vector<HygieneNote> notes() { return std::move(notes_); }

 private:
  std::string log_;
  std::vector<HygieneNote> notes_;
};

/// A number with so many digits behind the point.
std::string digits(double value, int behind = 1);

}  // namespace tread::gap
