// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/report/page.hpp"

#include <array>
#include <stdexcept>

#include <openssl/evp.h>

#include "common/report/text.hpp"

namespace tread {

std::string sha256(const std::string& bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest;
  unsigned int size = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1)
    throw std::runtime_error("SHA-256: libcrypto refuses to compute it");
  std::string text;
  for (unsigned int i = 0; i < size; ++i) {
    text += "0123456789abcdef"[digest[i] >> 4];
    text += "0123456789abcdef"[digest[i] & 15];
  }
  return text;
}

}  // namespace tread

namespace tread::report {

namespace {

const char* const kStyle = R"(:root { color-scheme: light; }
* { box-sizing: border-box; }
body { font: 16px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, sans-serif; color: #1c2126; background: #fff;
  max-width: 68rem; margin: 0 auto; padding: 1rem; overflow-wrap: break-word; }
header { border-left: .45rem solid #2f6f9f; padding: .2rem 0 .2rem 1rem; margin: .5rem 0 2rem; }
header.good { border-color: #2e7d4f; } header.doubt { border-color: #b26a00; }
h1 { font-size: 1.6rem; line-height: 1.25; margin: 0 0 .6rem; }
h2 { font-size: 1.2rem; margin: 2.4rem 0 .6rem; border-top: 1px solid #dde1e5; padding-top: 1rem; }
p { margin: .5rem 0; max-width: 46rem; } p.small, figcaption { color: #5a646e; font-size: .88rem; }
.wide { overflow-x: auto; margin: .7rem 0; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: .92rem; }
th, td { padding: .25rem .7rem .25rem 0; text-align: right; vertical-align: top; }
th { font-weight: 600; border-bottom: 1.5px solid #5a646e; }
td { border-bottom: 1px solid #e8ebee; } .l { text-align: left; }
ul { padding-left: 1.2rem; max-width: 46rem; } li { margin: .3rem 0; }
pre { background: #f3f5f7; padding: .6rem .8rem; overflow-x: auto; font-size: .85rem; }
figure { margin: 1rem 0; } .pictures { display: grid; gap: .8rem;
  grid-template-columns: repeat(auto-fill, minmax(min(19rem, 100%), 1fr)); }
svg { display: block; width: 100%; height: auto; })";

/// Writes blocks one after the other.
struct HtmlWriter {
  std::string text;

  void operator()(const Paragraph& paragraph) {
    text += paragraph.small ? "<p class=\"small\">" : "<p>";
    text += escaped(paragraph.text) + "</p>\n";
  }

  void operator()(const Table& table) {
    text += "<div class=\"wide\"><table>\n<thead>";
    row(table.header, table.left, "th");
    text += "</thead>\n<tbody>\n";
    for (const std::vector<std::string>& cells : table.rows) row(cells, table.left, "td");
    text += "</tbody></table></div>\n";
  }

  void operator()(const Points& points) {
    text += "<ul>\n";
    for (const std::string& item : points.items) text += "<li>" + escaped(item) + "</li>\n";
    text += "</ul>\n";
  }

  void operator()(const Commands& commands) {
    text += "<pre>";
    for (const std::string& line : commands.lines) text += escaped(line) + "\n";
    text += "</pre>\n";
  }

  void operator()(const Pictures& pictures) {
    text += "<figure><div class=\"pictures\">\n";
    for (const std::string& svg : pictures.svg) text += svg + "\n";
    text += "</div><figcaption>" + escaped(pictures.caption) + "</figcaption></figure>\n";
  }

  void row(const std::vector<std::string>& cells, size_t left, const std::string& tag) {
    text += "<tr>";
    const std::string end = "</" + tag + ">";
    for (size_t i = 0; i < cells.size(); ++i)
      text.append("<")
          .append(tag)
          .append(i < left ? " class=\"l\">" : ">")
          .append(escaped(cells[i]))
          .append(end);
    text += "</tr>\n";
  }
};

/// Within a cell: no line ends, and | is escaped.
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

/// Writes blocks in order, each followed by an empty line.
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

std::string htmlOf(const Page& page) {
  HtmlWriter writer;
  writer.text =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\">\n<title>" +
      escaped(page.title) + "</title>\n<style>\n" + kStyle + "\n</style></head><body>\n";
  writer.text += "<header class=\"" + page.mood + "\"><h1>" + escaped(page.verdict) + "</h1>\n";
  for (const Block& block : page.first) std::visit(writer, block);
  writer.text += "</header>\n";
  for (const Section& section : page.sections) {
    writer.text += "<section><h2>" + escaped(section.title) + "</h2>\n";
    for (const Block& block : section.blocks) std::visit(writer, block);
    writer.text += "</section>\n";
  }
  return writer.text + "</body></html>\n";
}

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

}  // namespace tread::report
