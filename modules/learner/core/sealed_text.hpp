// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <sstream>
#include <string>

// Text files of the learner's memory: words and numbers that read back to the bit, and a last line
// that tells a damaged text from a whole one.
namespace tread::learner {

/// The shortest text that reads back as the same number, whatever the locale.
std::string number(double value);

/// The text with its last line, "end" and a fingerprint of what stands before.
std::string sealed(const std::string& content);
/// The text without that line; nothing if it is not that of the text.
std::optional<std::string> unsealed(const std::string& text);

/// Reads words and numbers; once something is missing everything after fails, too.
class Words {
 public:
  explicit Words(const std::string& text) : in_(text) {}

  bool good() const { return good_; }
  void require(bool condition) { good_ = good_ && condition; }
  void expect(const char* word);
  std::string word();
  int64_t integer();
  double real();

 private:
  std::istringstream in_;
  bool good_ = true;
};

}  // namespace tread::learner
