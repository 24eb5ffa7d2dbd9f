// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/report/page.hpp"

namespace tread::gap {
namespace {

/// Within a cell: no line ends, and a bar is no border.
std::string cellText(const std::string& text) {
  std::string safe;
  for (const char letter : text) {
    if (letter == '|') safe += '\\';
    safe += letter == '\n' ? ' ' : letter;
  }
  return safe.empty() ? " " : safe;
}

std::string rowText(const std::vector<std::string>& cells) {
  std::string text = "|";
  for (const std::string& cell : cells) text += " " + cellText(cell) + " |";
  return text + "\n";
}

/// Writes blocks one after the other, an empty line behind each.
struct MarkdownWriter {
  std::string text;

  void operator()(const Paragraph& paragraph) { text += paragraph.text + "\n\n"; }

  void operator()(const Table& table) {
    text += rowText(table.header) + "|";
    for (size_t i = 0; i < table.header.size(); ++i) text += i < table.left ? "---|" : "---:|";
    text += "\n";
    for (const std::vector<std::string>& cells : table.rows) text += rowText(cells);
    text += "\n";
  }

  void operator()(const Points& points) {
    for (const std::string& item : points.items) text += "- " + item + "\n";
    text += "\n";
  }

  void operator()(const Commands& commands) {
    for (const std::string& line : commands.lines) text += "    " + line + "\n";
    text += "\n";
  }

  void operator()(const Pictures& pictures) {
    text += "*Pictures in report.html: " + pictures.caption + "*\n\n";
  }
};

}  // namespace

std::string markdownOf(const Page& page) {
  MarkdownWriter writer;
  writer.text = "# " + page.verdict + "\n\n";
  for (const Block& block : page.first) std::visit(writer, block);
  for (const Section& section : page.sections) {
    writer.text += "## " + section.title + "\n\n";
    for (const Block& block : section.blocks) std::visit(writer, block);
  }
  return writer.text;
}

}  // namespace tread::gap
