// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "common/report/page.hpp"
#include "common/report/text.hpp"
#include "tools/robot/why/debrief.hpp"

namespace tread::why {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kNear = 5.0;      // [s] around the requested time
constexpr size_t kMostShown = 40;  // findings on the terminal

std::string timeOf(double seconds) {
  const int minutes = static_cast<int>(seconds / 60.0);
  return minutes > 0 ? formatted("%d:%04.1f", minutes, seconds - 60.0 * minutes)
                     : formatted("%.1f s", seconds);
}

std::string headlineOf(const Debrief& debrief) {
  const DriveFigures& figures = debrief.figures;
  std::string line =
      formatted("%.1f m in %s, ", figures.distance, timeOf(figures.duration).c_str());
  line += figures.goals == 0 ? std::string("no goal")
                             : formatted("%d of %d goals reached", figures.reached, figures.goals);
  line += formatted(", %d unplanned stops", figures.stops);
  return line;
}

std::string verdictOf(const Debrief& debrief) {
  const Finding* const worst = debrief.worst();
  if (worst == nullptr) return "nothing went wrong";
  return timeOf(worst->time) + ": " + worst->sentence;
}

std::vector<std::string> figureLines(const Debrief& debrief) {
  const DriveFigures& figures = debrief.figures;
  std::vector<std::string> lines;
  lines.push_back(formatted("%d patterns driven to their end, %d aborted, %d fair measurements",
                            figures.patterns, figures.aborted, figures.measured));
  if (std::isfinite(figures.error_position))
    lines.push_back(formatted("half of them ended within %.3f m and %.2f deg of their predictions",
                              figures.error_position, figures.error_yaw * 57.2957795));
  if (std::isfinite(figures.battery_begin))
    lines.push_back(formatted("battery %.1f V at the beginning, %.1f V at the end",
                              figures.battery_begin, figures.battery_end));
  return lines;
}

std::string evidenceOf(const Evidence& evidence) {
  return timeOf(evidence.time) + " " + evidence.channel + ": " + evidence.words;
}

report::Table tableOf(const std::vector<Difference>& differences) {
  report::Table table{{"what", "before", "now"}, {}, 3};
  for (const Difference& difference : differences)
    table.rows.push_back({difference.what, difference.before, difference.now});
  return table;
}

Json jsonOfDifferences(const std::vector<Difference>& differences) {
  Json all = Json::array();
  for (const Difference& difference : differences)
    all.push_back(
        {{"what", difference.what}, {"before", difference.before}, {"now", difference.now}});
  return all;
}

}  // namespace

std::string textOf(const Debrief& debrief, double at) {
  std::string text = debrief.name + ": " + headlineOf(debrief) + "\n";
  if (!debrief.problem.empty()) text += debrief.problem + "\n";
  if (at < 0.0) {
    text += "why: " + verdictOf(debrief) + "\n";
    for (const std::string& line : figureLines(debrief)) text += "  " + line + "\n";
  }
  size_t shown = 0, more = 0;
  for (const Finding& finding : debrief.findings) {
    if (at >= 0.0 && (at < finding.time - kNear || at > finding.until + kNear)) continue;
    if (++shown > kMostShown) {
      ++more;
      continue;
    }
    text +=
        "\n" + timeOf(finding.time) + "  " + nameOf(finding.kind) + ": " + finding.sentence + "\n";
    for (const Evidence& evidence : finding.evidence) text += "    " + evidenceOf(evidence) + "\n";
  }
  if (more > 0) text += formatted("\nand %zu more; --json has all\n", more);
  if (at >= 0.0 && shown == 0) text += "no findings within 5 s of " + timeOf(at) + "\n";
  return text;
}

std::string htmlOf(const Debrief& debrief, const Debrief* other) {
  report::Page page;
  page.title = "Why: " + debrief.name;
  page.verdict = asSentence(verdictOf(debrief));
  const Finding* const worst = debrief.worst();
  page.mood = worst == nullptr ? "good" : worst->kind == FindingKind::kStop ? "change" : "doubt";
  page.first.push_back(report::Paragraph{asSentence(headlineOf(debrief)) + "."});
  if (!debrief.problem.empty()) page.first.push_back(report::Paragraph{debrief.problem});
  page.first.push_back(report::Points{figureLines(debrief)});
  report::Section events{"What happened", {}};
  for (const Finding& finding : debrief.findings) {
    events.blocks.push_back(report::Paragraph{timeOf(finding.time) + ", " + nameOf(finding.kind) +
                                              ": " + finding.sentence});
    report::Points points;
    for (const Evidence& evidence : finding.evidence) points.items.push_back(evidenceOf(evidence));
    events.blocks.push_back(points);
  }
  if (debrief.findings.empty()) events.blocks.push_back(report::Paragraph{"No unplanned events."});
  page.sections.push_back(std::move(events));
  if (other != nullptr) {
    page.sections.push_back(
        {"Against " + other->name, {tableOf(driveDifferences(*other, debrief))}});
    page.sections.push_back({"Configuration", {tableOf(configDifferences(*other, debrief))}});
  }
  return report::htmlOf(page);
}

std::string jsonOf(const Debrief& debrief, const Debrief* other) {
  const DriveFigures& figures = debrief.figures;
  Json json{{"log", debrief.name}, {"problem", debrief.problem}};
  json["figures"] = {{"duration", figures.duration},
                     {"distance", figures.distance},
                     {"goals", figures.goals},
                     {"reached", figures.reached},
                     {"stops", figures.stops},
                     {"patterns", figures.patterns},
                     {"aborted", figures.aborted},
                     {"measured", figures.measured},
                     {"error_position", figures.error_position},
                     {"error_yaw", figures.error_yaw},
                     {"battery_begin", figures.battery_begin},
                     {"battery_end", figures.battery_end}};
  const Finding* const worst = debrief.worst();
  json["worst"] = worst == nullptr ? Json(nullptr) : Json(worst - debrief.findings.data());
  json["findings"] = Json::array();
  for (const Finding& finding : debrief.findings) {
    Json evidence = Json::array();
    for (const Evidence& item : finding.evidence)
      evidence.push_back({{"time", item.time}, {"channel", item.channel}, {"words", item.words}});
    json["findings"].push_back({{"kind", nameOf(finding.kind)},
                                {"time", finding.time},
                                {"until", finding.until},
                                {"cause", finding.cause},
                                {"sentence", finding.sentence},
                                {"evidence", evidence}});
  }
  if (other != nullptr)
    json["against"] = {{"log", other->name},
                       {"drive", jsonOfDifferences(driveDifferences(*other, debrief))},
                       {"configuration", jsonOfDifferences(configDifferences(*other, debrief))}};
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace tread::why
