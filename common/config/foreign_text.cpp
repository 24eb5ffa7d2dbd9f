// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/config/foreign_text.hpp"

#include <charconv>

namespace tread {

std::optional<double> parseForeignNumber(std::string_view text) {
  const bool signed_already = text.substr(0, 1) == "+";
  if (signed_already) text.remove_prefix(1);
  const size_t first = !signed_already && text.substr(0, 1) == "-" ? 1 : 0;
  // from_chars also accepts inf and nan.
  if (text.find_first_of("0123456789.", first) != first) return std::nullopt;
  double value = 0.0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc() || result.ptr != text.data() + text.size()) return std::nullopt;
  return value;
}

std::string takeByteOrderMark(std::string& text) {
  if (text.compare(0, 3, "\xEF\xBB\xBF") == 0) text.erase(0, 3);
  const auto zero = [&](size_t at) { return at < text.size() && text[at] == '\0'; };
  const std::string mark = text.substr(0, 2);
  if (mark == "\xFF\xFE" || mark == "\xFE\xFF" || zero(0) != zero(1))
    return "is UTF-16 text; save it as UTF-8 (a spreadsheet: as \"CSV UTF-8\")";
  return {};
}

}  // namespace tread
