// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>

#include "tests/study/models/ladder_output.hpp"

namespace tread::gap {

using namespace report;

namespace {

/// Columns of spaces; the last one is not filled up.
std::string plain(const Table& table) {
  std::vector<std::vector<std::string>> lines{table.header};
  lines.insert(lines.end(), table.rows.begin(), table.rows.end());
  std::vector<size_t> widths(table.header.size(), 0);
  for (const auto& line : lines)
    for (size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  std::string text;
  for (const auto& line : lines) {
    for (size_t i = 0; i < line.size(); ++i) {
      const std::string fill(widths[i] - line[i].size(), ' ');
      const bool left = i < table.left;
      text += (i > 0 ? "  " : "") + (left ? line[i] : fill + line[i]);
      if (left && i + 1 < line.size()) text += fill;
    }
    text += "\n";
  }
  return text;
}

struct TextWriter {
  std::string text;

  void operator()(const Paragraph& paragraph) { text += paragraph.text + "\n"; }
  void operator()(const Table& table) { text += plain(table) + "\n"; }
  void operator()(const Points& points) {
    for (const std::string& item : points.items) text += item + "\n";
  }
  void operator()(const Commands&) {}
  void operator()(const Pictures&) {}
};

}  // namespace

std::string ladderText(const LadderReport& report) {
  TextWriter writer;
  for (const Section& section : ladderPage(report).sections) {
    writer.text += "\n" + section.title + "\n\n";
    for (const Block& block : section.blocks) std::visit(writer, block);
  }
  return writer.text;
}

}  // namespace tread::gap
