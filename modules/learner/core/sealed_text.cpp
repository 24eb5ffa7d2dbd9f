// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/sealed_text.hpp"

#include <array>
#include <charconv>
#include <system_error>

namespace tread::learner {
namespace {

/// FNV-1a, 64 bits: tells a damaged text from a whole one.
uint64_t fingerprint(const std::string& text) {
  uint64_t hash = 14695981039346656037ULL;
  for (const char letter : text) {
    hash ^= static_cast<unsigned char>(letter);
    hash *= 1099511628211ULL;
  }
  return hash;
}

std::string hexadecimal(uint64_t value) {
  std::array<char, 20> text;
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value, 16);
  return {text.data(), result.ptr};
}

std::string lastLine(const std::string& content) {
  return "end " + hexadecimal(fingerprint(content)) + "\n";
}

}  // namespace

std::string number(double value) {
  std::array<char, 40> text;
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), result.ptr};
}

std::string sealed(const std::string& content) {
  return content + lastLine(content);
}

std::optional<std::string> unsealed(const std::string& text) {
  const size_t end = text.rfind("end ");
  if (end == std::string::npos || end == 0 || text[end - 1] != '\n') return std::nullopt;
  std::string content = text.substr(0, end);
  if (text.substr(end) != lastLine(content)) return std::nullopt;
  return content;
}

void Words::expect(const char* word) {
  std::string found;
  good_ = good_ && (in_ >> found) && found == word;
}

std::string Words::word() {
  std::string found;
  good_ = good_ && (in_ >> found);
  return found;
}

int64_t Words::integer() {
  int64_t value = 0;
  good_ = good_ && (in_ >> value);
  return good_ ? value : 0;
}

double Words::real() {
  const std::string text = word();
  double value = 0.0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  good_ = good_ && result.ec == std::errc() && result.ptr == text.data() + text.size();
  return value;
}

}  // namespace tread::learner
