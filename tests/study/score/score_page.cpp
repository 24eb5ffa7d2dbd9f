// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cmath>

#include "common/report/plot.hpp"
#include "common/report/text.hpp"
#include "tests/study/score/score_files.hpp"

namespace tread::blindtest {
namespace {

using report::Box;
using report::Colour;
using report::Picture;

constexpr double kCell = 22.0;    // [pixels]
constexpr double kLeft = 230.0;   // names of rows
constexpr double kTop = 70.0;     // numbers of columns
constexpr double kLeast = 860.0;  // needed by title and legend

const char* const kHead = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>Blind test</title><style>
body { font: 15px/1.45 sans-serif; color: #222; max-width: 1180px; margin: 2em auto; padding: 0 1em; }
h1 { font-size: 1.5em; } h2 { font-size: 1.1em; margin-top: 1.8em; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
td { padding: .12em .8em .12em 0; border-bottom: 1px solid #ddd; } img { max-width: 100%; }
.short { color: #b03a00; font-weight: 600; }
</style></head><body>
)";

/// White for never, dark for always; wrong names are red.
Colour shade(double share, bool right) {
  const Colour full = right ? report::kBlue : report::kRed;
  const auto mix = [&](double part) { return 1.0 + share * (part - 1.0); };
  return {mix(full.red), mix(full.green), mix(full.blue)};
}

std::string percentWord(double share) {
  return fixed(100.0 * share, 0);
}

void drawRow(const Confusion& confusion, size_t row, Picture& picture) {
  const double y = kTop + kCell * static_cast<double>(row);
  const std::string& hidden = confusion.hidden[row];
  const auto place = std::find(confusion.named.begin(), confusion.named.end(), hidden);
  const auto number = place - confusion.named.begin() + 1;
  picture.text(
      12.0, y + 15.0,
      std::to_string(number) + "  " + hidden + " (" + std::to_string(confusion.cases[row]) + ")",
      12.0);
  for (size_t column = 0; column < confusion.named.size(); ++column) {
    const double share = confusion.share[row][column];
    const Box box{kLeft + kCell * static_cast<double>(column), y, kCell - 1.0, kCell - 1.0};
    const bool right = confusion.named[column] == hidden;
    picture.fill(box, share > 0.0 ? shade(0.15 + 0.85 * share, right) : Colour{0.96, 0.96, 0.96});
    if (share > 0.0)
      picture.text(box.x + (share < 0.995 ? 4.0 : 1.0), y + 15.0, percentWord(share), 10.0,
                   share > 0.5 ? Colour{1.0, 1.0, 1.0} : report::kBlack);
  }
}

std::string sectionTable(const ScoredStudy& study, const std::string& section) {
  std::string html = "<h2>" + escaped(section) + "</h2>\n<table>\n";
  for (const ScoreLine& line : study.scores) {
    if (line.section != section) continue;
    const std::string met = metWords(line);
    html += "<tr><td>" + escaped(line.what) + "</td><td>" + escaped(figureWords(line)) +
            "</td><td>" + escaped(mustWords(line)) + "</td><td" +
            (met == "not met" ? " class=\"short\"" : "") + ">" + met + "</td></tr>\n";
  }
  return html + "</table>\n";
}

}  // namespace

void drawConfusion(const Confusion& confusion, const std::string& path) {
  const auto columns = static_cast<double>(confusion.named.size());
  const auto rows = static_cast<double>(confusion.hidden.size());
  Picture picture(static_cast<int>(std::max(kLeast, kLeft + kCell * columns + 20.0)),
                  static_cast<int>(kTop + kCell * rows + 60.0),
                  "Hidden effects (rows, cases) and named effects (columns) [% of the cases]");
  // The last three columns are not effects.
  for (size_t i = 0; i < confusion.named.size(); ++i)
    picture.text(kLeft + kCell * static_cast<double>(i) + 3.0, kTop - 6.0, std::to_string(i + 1),
                 11.0);
  for (size_t row = 0; row < confusion.hidden.size(); ++row) drawRow(confusion, row, picture);
  std::string last;
  for (size_t i = confusion.named.size() - 3; i < confusion.named.size(); ++i)
    last += std::to_string(i + 1) + " = " + confusion.named[i] + "   ";
  picture.text(12.0, kTop + kCell * rows + 30.0, "Columns have the rows' numbers; " + last, 12.0);
  // Names that were never hidden have no row.
  std::string others;
  for (size_t i = 0; i + 3 < confusion.named.size(); ++i)
    if (std::find(confusion.hidden.begin(), confusion.hidden.end(), confusion.named[i]) ==
        confusion.hidden.end())
      others += std::to_string(i + 1) + " = " + confusion.named[i] + "   ";
  if (!others.empty())
    picture.text(12.0, kTop + kCell * rows + 48.0, "Never hidden: " + others, 12.0);
  picture.save(path);
}

std::string pageHtml(const ScoredStudy& study, const std::string& png) {
  std::string html = kHead;
  html +=
      "<h1>Blind test: hidden effects, and what tread-gap named</h1>\n<p>Suite " +
      escaped(study.header.value("suite", "?")) + ", seed " +
      std::to_string(study.header.value("seed", 0)) + ": " + std::to_string(study.cases.size()) +
      " logs. Values with 95 % interval (Wilson's of a share, of order statistics of a quantile); "
      "what must be is met or not met where the whole interval says so. Excited: the effect "
      "changes "
      "the motion by 5 % of the noise or more. Gap closed: of 2 s end errors (position and "
      "yaw, rms, in units of what the truth itself misses), where they were more than 5 % above "
      "that.</p>\n";
  html += sectionTable(study, "must");
  html += "<h2>confusion</h2>\n<p><img alt=\"confusion matrix\" src=\"data:image/png;base64," +
          base64(png) + "\"></p>\n";
  std::string done = "must";
  for (const ScoreLine& line : study.scores)
    if (line.section != "must" && line.section != done)
      html += sectionTable(study, done = line.section);
  return html + "</body></html>\n";
}

}  // namespace tread::blindtest
