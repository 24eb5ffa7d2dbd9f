// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/experiment/adaptation/adaptation_report.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "common/geometry/degrees.hpp"
#include "common/report/page.hpp"
#include "common/report/text.hpp"
#include "common/store/store.hpp"
#include "tools/lab/experiment/adaptation/ratio_picture.hpp"
#include "tools/lab/experiment/adaptation/summary.hpp"

namespace tread::adaptation {
namespace {

std::string titleOf(const Group& group) {
  return std::string(nameOf(group.kind)) + " left out, " + group.vehicle + ", " +
         std::to_string(group.horizon) + " s ahead";
}

std::string ratio(double value) {
  return std::isfinite(value) ? fixed(value, 3) : "-";
}

/// For instance "position / yaw".
std::string both(const std::string& position, const std::string& yaw) {
  return position + " / " + yaw;
}

std::string errorCell(const SummaryLine& line) {
  if (line.sessions == 0) return "-";
  return both(fixed(line.position.error, 3), fixed(line.yaw.error, 2));
}

std::string ratioCell(const SummaryLine& line) {
  if (line.sessions == 0) return "-";
  return both(ratio(line.position.ratio.value), ratio(line.yaw.ratio.value));
}

std::string intervalCell(const SummaryLine& line) {
  const auto of = [](const ConfidenceInterval& interval) {
    return fixed(interval.low, 2) + ".." + fixed(interval.high, 2);
  };
  if (!std::isfinite(line.position.ratio.low)) return "-";
  return both(of(line.position.ratio), of(line.yaw.ratio));
}

std::string worstCell(const SummaryLine& line) {
  if (line.sessions == 0) return "-";
  return both(ratio(line.position.worst), ratio(line.yaw.worst));
}

std::string verdictCell(const SummaryLine& line) {
  if (line.rule == kJudged || line.position.judged == Verdict::kUnknown) return "-";
  return both(nameOf(line.position.judged), nameOf(line.yaw.judged));
}

using CellText = std::string (*)(const SummaryLine&);

/// A table with a row per rule and a column per number of executions.
report::Table tableOf(const Group& group, const std::string& corner, CellText cell) {
  report::Table table{{corner}, {}, 1};
  for (const size_t k : kExecutions) table.header.push_back("k = " + std::to_string(k));
  for (const std::string& rule : group.rules) {
    table.rows.push_back({rule});
    for (const size_t k : kExecutions) table.rows.back().push_back(cell(group.of(rule, k)));
  }
  return table;
}

std::string textOf(const report::Table& table) {
  std::string text;
  const auto add = [&](const std::vector<std::string>& cells) {
    for (size_t i = 0; i < cells.size(); ++i)
      text += formatted(i == 0 ? "%-24s" : "%17s", cells[i].c_str());
    text += "\n";
  };
  add(table.header);
  for (const std::vector<std::string>& row : table.rows) add(row);
  return text;
}

std::string sessionsOf(const Group& group) {
  std::string text = "Sessions:";
  for (const size_t k : kExecutions)
    text += " " + std::to_string(group.of(kOff, k).sessions) + " (k = " + std::to_string(k) + ")";
  return text;
}

/// Share of single pieces inside the judged rule's 90 % regions from three executions on, by
/// surface; empty if it states none.
std::string regionsOf(const Report& report) {
  const auto& rules = report.settings.rules;
  const auto judged = std::find(rules.begin(), rules.end(), kJudged);
  if (judged == rules.end()) return "";
  std::map<std::string, std::pair<size_t, size_t>> surfaces;  // inside, stated
  for (const SessionErrors& session : report.errors.sessions) {
    if (session.kind != HeldOut::kSession) continue;
    const auto& of_rule = session.cells[static_cast<size_t>(judged - rules.begin())];
    for (size_t k = 0; k < kExecutions.size(); ++k)
      for (const Cell& cell : of_rule[k]) {
        if (kExecutions[k] < 3 || cell.stated == 0) continue;
        for (const std::string& name : {session.surface, std::string("all")}) {
          surfaces[name].first += cell.inside;
          surfaces[name].second += cell.stated;
        }
      }
  }
  std::vector<std::string> shares;
  for (const auto& [name, count] : surfaces)
    shares.push_back(
        name + " " +
        fixed(100.0 * static_cast<double>(count.first) / static_cast<double>(count.second), 1) +
        " %");
  if (shares.empty()) return "";
  return std::string("90 % regions of ") + kJudged +
         " that hold the next execution, sessions left out, after 3, 10 and 30 executions: " +
         joined(shares) + ".";
}

/// Main results: the judged rule compared with no learning and with the others after 3 executions.
std::vector<std::string> findings(const std::vector<Group>& groups, const Report& report) {
  constexpr size_t kEarly = 3;
  std::vector<std::string> points;
  const auto& rules = report.settings.rules;
  if (std::find(rules.begin(), rules.end(), kJudged) == rules.end()) return points;
  for (const Group& group : groups) {
    const SummaryLine& judged = group.of(kJudged, kEarly);
    if (judged.sessions == 0) continue;
    std::vector<std::string> lost;
    for (const std::string& rule : group.rules) {
      const SummaryLine& line = group.of(rule, kEarly);
      if (rule == kHindsight) continue;
      if (line.position.judged == Verdict::kWorse) lost.push_back(rule + " (position)");
      if (line.yaw.judged == Verdict::kWorse) lost.push_back(rule + " (yaw)");
    }
    const auto change = [](double ratio) { return formatted("%+.1f %%", 100.0 * (ratio - 1.0)); };
    points.push_back(titleOf(group) + ", after " + std::to_string(kEarly) + " executions: " +
                     kJudged + " relative to no learning " + change(judged.position.ratio.value) +
                     " position, " + change(judged.yaw.ratio.value) + " yaw; worst session " +
                     change(judged.position.worst) + " (" + judged.position.worst_session + "), " +
                     change(judged.yaw.worst) + " (" + judged.yaw.worst_session + "). " +
                     (judged.sessions < 2 ? "One session: no interval."
                      : lost.empty()      ? "Better than or level with every other rule."
                                          : "Worse than " + joined(lost) + "."));
  }
  if (const std::string regions = regionsOf(report); !regions.empty()) points.push_back(regions);
  return points;
}

report::Page pageOf(const std::vector<Group>& groups, const Report& report,
                    const std::string& png) {
  report::Page page;
  page.title = "Adaptation to new sessions, surfaces and vehicles";
  page.verdict = page.title + ": " + report.source;
  page.first = {
      report::Paragraph{
          "A session, surface or vehicle is left out; the model with which all rules start is "
          "fitted to the "
          "others. After k executions of two seconds there, the next 2, 5 and 10 s are predicted "
          "open loop. Ratio: error relative to no learning at the same places, mean over "
          "sessions; intervals of 95 % by bootstrap of sessions. Better, level, worse: " +
          std::string(kJudged) +
          " compared with the rule of the row; level means within one standard error over "
          "sessions."},
      report::Points{findings(groups, report)},
      report::Pictures{{"<img style=\"grid-column: 1 / -1; max-width: 100%\" alt=\"ratios over "
                        "executions\" src=\"data:image/png;base64," +
                        base64(readText(png)) + "\">"},
                       "hindsight is fitted to the whole session: a bound, not a rule"}};
  for (const Group& group : groups)
    page.sections.push_back(
        {titleOf(group),
         {report::Paragraph{sessionsOf(group) + ". Position / yaw."},
          tableOf(group, "error [m] / [deg]", errorCell), tableOf(group, "ratio to off", ratioCell),
          tableOf(group, "95 % interval", intervalCell), tableOf(group, "worst session", worstCell),
          tableOf(group, std::string(kJudged) + " is", verdictCell)}});
  if (!report.notes.empty())
    page.sections.push_back({"About the recordings", {report::Points{report.notes}}});
  return page;
}

std::string numberCsv(double value) {
  return std::isfinite(value) ? formatted("%.6g", value) : "";
}

std::string standingCsv(const Standing& standing) {
  std::string text;
  for (const double value : {standing.error, standing.ratio.value, standing.ratio.low,
                             standing.ratio.high, standing.worst})
    text += "," + numberCsv(value);
  return text + "," + standing.worst_session + "," + numberCsv(standing.difference) + "," +
         numberCsv(standing.standard_error) + "," + nameOf(standing.judged);
}

}  // namespace

const SummaryLine& Group::of(const std::string& rule, size_t executions) const {
  return **std::find_if(lines.begin(), lines.end(), [&](const SummaryLine* line) {
    return line->rule == rule && line->executions == executions;
  });
}

std::vector<Group> groupsOf(const Report& report) {
  std::vector<Group> groups;
  for (const SummaryLine& line : report.lines) {
    if (groups.empty() || groups.back().kind != line.kind ||
        groups.back().vehicle != line.vehicle || groups.back().horizon != line.horizon)
      groups.push_back({line.kind, line.vehicle, line.horizon, {}, {}});
    Group& group = groups.back();
    group.lines.push_back(&line);
    // Another vehicle has no history here, so the row would be a duplicate.
    const bool home = line.rule.find(kHome) != std::string::npos;
    if (group.rules.empty() || group.rules.back() != line.rule)
      if (!home || group.kind != HeldOut::kVehicle) group.rules.push_back(line.rule);
  }
  return groups;
}

std::string textOf(const Report& report) {
  std::string text;
  const std::vector<Group> groups = groupsOf(report);
  for (const Group& group : groups) {
    text += titleOf(group) + ". " + sessionsOf(group) + "\n";
    text += textOf(tableOf(group, "ratio to off", ratioCell));
    text += textOf(tableOf(group, std::string(kJudged) + " is", verdictCell)) + "\n";
  }
  for (const std::string& finding : findings(groups, report)) text += finding + "\n";
  for (const std::string& note : report.notes) text += "Note: " + note + "\n";
  return text;
}

std::string csvOfLines(const Report& report) {
  std::string text =
      "left_out,vehicle,horizon_s,rule,executions,sessions,position_m,position_ratio,"
      "position_ratio_low,position_ratio_high,position_worst,position_worst_session,"
      "position_judged_less_this,position_standard_error,position_judged_is,yaw_deg,yaw_ratio,"
      "yaw_ratio_low,yaw_ratio_high,yaw_worst,yaw_worst_session,yaw_judged_less_this,"
      "yaw_standard_error,yaw_judged_is\n";
  for (const SummaryLine& line : report.lines)
    text += std::string(nameOf(line.kind)) + ",\"" + line.vehicle + "\"," +
            std::to_string(line.horizon) + "," + line.rule + "," + std::to_string(line.executions) +
            "," + std::to_string(line.sessions) + standingCsv(line.position) +
            standingCsv(line.yaw) + "\n";
  return text;
}

std::string csvOfSessions(const Report& report) {
  std::string text =
      "left_out,session,vehicle,surface,horizon_s,rule,executions,starts,position_m,yaw_deg\n";
  for (const SessionErrors& session : report.errors.sessions)
    for (size_t h = 0; h < kHorizons.size(); ++h)
      for (size_t rule = 0; rule < report.settings.rules.size(); ++rule)
        for (size_t k = 0; k < kExecutions.size(); ++k) {
          const Cell& cell = session.cells[rule][k][h];
          if (cell.starts == 0) continue;
          text += std::string(nameOf(session.kind)) + "," + session.session + ",\"" +
                  session.vehicle + "\",\"" + session.surface + "\"," +
                  std::to_string(kHorizons[h]) + "," + report.settings.rules[rule] + "," +
                  std::to_string(kExecutions[k]) + "," + std::to_string(cell.starts) + "," +
                  numberCsv(cell.position) + "," + numberCsv(toDegrees(cell.yaw)) + "\n";
        }
  return text;
}

void writeReport(const std::string& folder, const Report& report) {
  const auto path = [&](const char* name) {
    return (std::filesystem::path(folder) / name).string();
  };
  writeText(path("adaptation.csv"), csvOfLines(report));
  writeText(path("sessions.csv"), csvOfSessions(report));
  const std::vector<Group> groups = groupsOf(report);
  drawRatios(path("adaptation.png"), groups);
  writeText(path("adaptation.html"),
            report::htmlOf(pageOf(groups, report, path("adaptation.png"))));
}

}  // namespace tread::adaptation
