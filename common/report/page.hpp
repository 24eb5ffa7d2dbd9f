// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <variant>
#include <vector>

namespace tread {

/// SHA-256 (FIPS 180-4) of bytes, as 64 hexadecimal digits.
std::string sha256(const std::string& bytes);

}  // namespace tread

namespace tread::report {

/// Colours of the pictures, distinguishable also with colour blindness.
inline constexpr const char* kInk = "#1c2126";
inline constexpr const char* kGreyInk = "#8a949e";
inline constexpr const char* kBeforeColour = "#d0661c";
inline constexpr const char* kAfterColour = "#1f6fb2";

/// A sentence or more.
struct Paragraph {
  std::string text;
  bool small = false;
};

/// Rows of cells; the first `left` columns are left-aligned, the others right-aligned.
struct Table {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
  size_t left = 1;  ///< number of left-aligned columns
};

/// A list of bullet points.
struct Points {
  std::vector<std::string> items;
};

/// Lines to type.
struct Commands {
  std::vector<std::string> lines;
};

/// Pictures side by side, as many as fit in a row.
struct Pictures {
  std::vector<std::string> svg;
  std::string caption;
};

using Block = std::variant<Paragraph, Table, Points, Commands, Pictures>;

/// A heading and its content.
struct Section {
  std::string title;
  std::vector<Block> blocks;
};

/// A report: the most important facts first, then sections with details.
struct Page {
  std::string title;    ///< of the window
  std::string verdict;  ///< the headline
  std::string mood;     ///< good, change, doubt: the colour of the headline
  std::vector<Block> first;
  std::vector<Section> sections;
};

/// One self-contained HTML file: no scripts, no external resources.
std::string htmlOf(const Page& page);

/// The same in Markdown, without pictures.
std::string markdownOf(const Page& page);

}  // namespace tread::report
