// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <variant>
#include <vector>

namespace tread::report {

/// A sentence or more.
struct Paragraph {
  std::string text;
  bool small = false;
};

/// Rows of cells; the first column is left-aligned, the others to the right unless said so.
struct Table {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
  size_t left = 1;  ///< so many columns are left-aligned
};

/// Points, one below the other.
struct Points {
  std::vector<std::string> items;
};

/// Lines to type.
struct Commands {
  std::vector<std::string> lines;
};

/// Pictures side by side, as many as fit.
struct Pictures {
  std::vector<std::string> svg;
  std::string caption;
};

using Block = std::variant<Paragraph, Table, Points, Commands, Pictures>;

/// A heading and what stands below it.
struct Section {
  std::string title;
  std::vector<Block> blocks;
};

/// A report: what one must know first, then sections with the details.
struct Page {
  std::string title;    ///< of the window
  std::string verdict;  ///< the headline
  std::string mood;     ///< good, change, doubt: the colour of the headline
  std::vector<Block> first;
  std::vector<Section> sections;
};

/// One self-contained HTML file: no scripts, nothing from elsewhere.
std::string htmlOf(const Page& page);

/// The same in Markdown; pictures are in the HTML only.
std::string markdownOf(const Page& page);

}  // namespace tread::report
