// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/config/scalars.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdio>
#include <numeric>

namespace tread {
namespace {

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

/// Skips digits; false if there are none.
bool skipDigits(const std::string& text, size_t& at) {
  const size_t first = at;
  while (at < text.size() && isDigit(text[at])) ++at;
  return at > first;
}

/// Skips an integer part without leading zeros: YAML 1.1 reads 010 as eight, people as ten.
bool skipWhole(const std::string& text, size_t& at) {
  if (at < text.size() && text[at] == '-') ++at;
  const size_t first = at;
  return skipDigits(text, at) && (text[first] != '0' || at == first + 1);
}

bool isDecimal(const std::string& text) {
  size_t at = 0;
  const bool whole = skipWhole(text, at);
  const bool begun = at > 0 && isDigit(text[at - 1]);  // 01, which is not an integer part
  if (!whole && (begun || at == text.size() || text[at] != '.')) return false;
  if (at < text.size() && text[at] == '.') {
    ++at;
    if (!skipDigits(text, at) && !whole) return false;
  }
  if (at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    ++at;
    if (at < text.size() && (text[at] == '+' || text[at] == '-')) ++at;
    if (!skipDigits(text, at)) return false;
  }
  return at == text.size();
}

/// Words that a YAML reader may not read as text.
bool isReserved(std::string word) {
  std::transform(word.begin(), word.end(), word.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  static const std::array<const char*, 12> kReserved{"null", "true", "false", "yes", "no",  "on",
                                                     "off",  "y",    "n",     "inf", "nan", "e"};
  return std::find(kReserved.begin(), kReserved.end(), word) != kReserved.end();
}

bool isPlain(const std::string& text) {
  if (text.empty() || isReserved(text)) return false;
  const auto first = static_cast<unsigned char>(text.front());
  if (std::isalpha(first) == 0 && first != '/') return false;
  return std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '/' || c == '.';
  });
}

std::string escaped(char c) {
  if (c == '"' || c == '\\') return {'\\', c};
  if (c == '\n') return "\\n";
  if (c == '\t') return "\\t";
  const auto code = static_cast<unsigned char>(c);
  if (code >= 0x20 && code != 0x7f) return {c};
  std::array<char, 8> hex{};
  std::snprintf(hex.data(), hex.size(), "\\x%02x", static_cast<unsigned>(code));
  return hex.data();
}

/// Number of letters to insert, delete, replace or swap with a neighbour to turn a into b.
size_t spellingDistance(const std::string& a, const std::string& b) {
  std::vector<std::vector<size_t>> cost(a.size() + 1, std::vector<size_t>(b.size() + 1));
  for (size_t i = 0; i <= a.size(); ++i) cost[i][0] = i;
  std::iota(cost[0].begin(), cost[0].end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t replaced = cost[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      cost[i][j] = std::min({cost[i - 1][j] + 1, cost[i][j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        cost[i][j] = std::min(cost[i][j], cost[i - 2][j - 2] + 1);
    }
  }
  return cost[a.size()][b.size()];
}

}  // namespace

std::optional<double> parseNumber(const std::string& text) {
  if (!isDecimal(text)) return std::nullopt;
  double value = 0.0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc() || result.ptr != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<int64_t> parseInteger(const std::string& text) {
  size_t at = 0;
  if (!skipWhole(text, at) || at != text.size()) return std::nullopt;
  int64_t value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc()) return std::nullopt;
  return value;
}

std::string formatNumber(double value) {
  std::array<char, 40> text{};
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), result.ptr};
}

std::string formatText(const std::string& text) {
  if (isPlain(text)) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += escaped(c);
  return quoted + '"';
}

std::optional<std::string> nearestSpelling(const std::string& word,
                                           const std::vector<std::string>& candidates) {
  constexpr size_t kLongestWord = 100;
  if (word.size() > kLongestWord) return std::nullopt;
  std::optional<std::string> nearest;
  size_t least = std::max<size_t>(1, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    if (candidate.size() > kLongestWord) continue;
    const size_t distance = spellingDistance(word, candidate);
    if (distance >= least) continue;
    least = distance;
    nearest = candidate;
  }
  return nearest;
}

std::string joinWords(const std::vector<std::string>& words) {
  std::string joined;
  for (const std::string& word : words) joined += (joined.empty() ? "" : ", ") + word;
  return joined;
}

}  // namespace tread
