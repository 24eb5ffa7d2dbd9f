// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/experiment/html_words.hpp"

#include <cmath>
#include <cstdio>

namespace tread::experiment {
namespace {

std::string base64(const std::string& bytes) {
  static const char kLetters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    unsigned group = 0;
    for (size_t j = 0; j < 3; ++j)
      group = group << 8 | (i + j < bytes.size() ? static_cast<unsigned char>(bytes[i + j]) : 0U);
    for (size_t j = 0; j < 4; ++j)
      text += i + j <= bytes.size() ? kLetters[group >> (18 - 6 * j) & 63U] : '=';
  }
  return text;
}

}  // namespace

const char* const kHtmlHead = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>Transitions between surfaces</title><style>
body { font: 15px/1.45 sans-serif; color: #222; max-width: 1240px; margin: 2em auto; padding: 0 1em; }
h1 { font-size: 1.5em; } h2 { font-size: 1.15em; margin-top: 2em; }
table { border-collapse: collapse; margin: .6em 0; font-variant-numeric: tabular-nums; }
th, td { padding: .15em .55em; text-align: right; white-space: nowrap; }
th { font-weight: 600; } thead tr:last-child th { border-bottom: 1.5px solid #555; }
td.name, th.name { text-align: left; } tr.first td, tr.first th { border-top: 1px solid #ccc; }
td.group, th.group { border-left: 1px solid #ccc; } .worse { color: #b03a00; }
.paper { display: block; color: #777; font-size: .8em; } .doubt { border-bottom: 1px dotted #b03a00; }
.wide { overflow-x: auto; } img { max-width: 100%; } pre { overflow-x: auto; font-size: .85em; }
p.small { color: #555; font-size: .9em; }
</style></head><body>
)";

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char letter : text) {
    if (letter == '<')
      safe += "&lt;";
    else if (letter == '>')
      safe += "&gt;";
    else if (letter == '&')
      safe += "&amp;";
    else if (letter == '"')
      safe += "&quot;";
    else
      safe += letter;
  }
  return safe;
}

std::string number(const char* format, double value) {
  char text[48];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string picture(const std::string& png, const std::string& words) {
  return "<p><img alt=\"" + escaped(words) + "\" src=\"data:image/png;base64," + base64(png) +
         "\"></p>\n";
}

std::string cell(const std::string& inside, const std::string& tip, bool group) {
  return "<td" + std::string(group ? " class=\"group\"" : "") +
         (tip.empty() ? "" : " title=\"" + escaped(tip) + "\"") + ">" + inside + "</td>";
}

std::string paperWords(double value, const char* format, const std::string& doubt) {
  const std::string text = number(format, value);
  if (doubt.empty()) return "<span class=\"paper\">" + text + "</span>";
  return "<span class=\"paper\"><span class=\"doubt\" title=\"" + escaped(doubt) + "\">" + text +
         "?</span></span>";
}

std::string intervalWords(const Row& row, const char* format) {
  std::string words =
      "99 %: " + number(format, row.estimate.low) + " to " + number(format, row.estimate.high);
  if (std::isfinite(row.spread)) words += "; deviation over books " + number(format, row.spread);
  return words;
}

}  // namespace tread::experiment
