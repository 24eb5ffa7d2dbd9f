// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors

#include "tools/lab/experiment/figures.hpp"

#include <algorithm>
#include <map>

#include "common/report/plot.hpp"
#include "tools/lab/experiment/tables.hpp"

namespace tread::experiment {
namespace {

using report::Box;
using report::Panel;
using report::Picture;
using report::Style;
using Points = std::vector<Eigen::Vector2d>;

constexpr double kWidth = 1400.0;
constexpr double kRow = 330.0;  // [pixels] height of a row of panels with its legend
constexpr double kLeft = 75.0;  // [pixels] left margin of a panel for its numbers

Style styleOf(const std::string& rule) {
  static const std::map<std::string, report::Colour> colours{
      {"off", report::kGrey},
      {"single", report::kBlue},
      {"collective", report::kRed},
      {"telescoping", report::kPink},
      {"collective_home", report::kRed},
      {"multi_model", report::kOrange},
      {"multi_model_home", report::kBlue},
      {"multi_model_unmet", report::kSkyBlue},
      {"multi_model_remembered", report::kGreen},
      {"constant", report::kBlue},
      {"kalman", report::kRed},
      {"slip", report::kOrange},
      {"gp", report::kGreen},
      {"basis", report::kPink},
      {"rls2", report::kSkyBlue},
      {"rls3", report::kBlue},
      {"imm", report::kGreen},
      {kOmniscient, report::kBlack}};
  const auto colour = colours.find(rule);
  Style style;
  style.colour = colour == colours.end() ? report::kBlack : colour->second;
  style.dashed = rule == "off" || rule == kOmniscient;
  // Collective and telescoping scaling often coincide: draw both visibly.
  style.width = style.dashed ? 1.5 : rule == "telescoping" ? 5.0 : 2.0;
  return style;
}

/// At most five curves per panel: the paper's rules, then the others, each group with the best
/// possible.
std::vector<std::vector<size_t>> curveGroups(const std::vector<std::string>& rules) {
  constexpr size_t kMost = 5;
  std::vector<size_t> papers, others;
  size_t best = rules.size();
  for (size_t i = 0; i < rules.size(); ++i) {
    const bool paper =
        std::find(paperRules().begin(), paperRules().end(), rules[i]) != paperRules().end();
    (paper ? papers : others).push_back(i);
    if (rules[i] == kOmniscient) best = i;
  }
  if (rules.size() <= kMost) {
    papers.insert(papers.end(), others.begin(), others.end());
    return {papers};
  }
  std::vector<std::vector<size_t>> groups;
  if (!papers.empty()) groups.push_back(papers);
  const size_t parts = (others.size() + kMost - 2) / (kMost - 1);
  for (size_t part = 0; part < parts; ++part) {
    std::vector<size_t> group(
        others.begin() + static_cast<long>(others.size() * part / parts),
        others.begin() + static_cast<long>(others.size() * (part + 1) / parts));
    if (best < rules.size()) group.push_back(best);
    groups.push_back(std::move(group));
  }
  return groups;
}

/// Legend in a line above the panels.
void drawLegend(Picture& picture, double x, double y, const std::vector<std::string>& rules,
                const std::vector<size_t>& group) {
  for (const size_t i : group) {
    const Style style = styleOf(rules[i]);
    const double height = std::max(2.0, style.width);
    picture.fill({x, y, style.dashed ? 9.0 : 26.0, height}, style.colour);
    if (style.dashed) picture.fill({x + 15.0, y, 9.0, height}, style.colour);
    picture.text(x + 30.0, y + 5.0, rules[i], 11.0);
    x += 36.0 + 6.8 * static_cast<double>(rules[i].size());
  }
}

double largest(const std::vector<Points>& curves) {
  double y = 0.0;
  for (const Points& curve : curves)
    for (const Eigen::Vector2d& point : curve) y = std::max(y, point.y());
  return y;
}

/// One panel with a curve for each rule of a group.
void drawCurves(Picture& picture, Box box, Panel::Axes axes, const std::vector<Points>& curves,
                const std::vector<std::string>& rules, const std::vector<size_t>& group) {
  Panel panel(picture, box, axes);
  for (const bool wide : {true, false})
    for (const size_t i : group)
      if (!curves[i].empty() && (styleOf(rules[i]).width > 2.0) == wide)
        panel.line(curves[i], styleOf(rules[i]));
  panel.finish();
}

/// Curves of one column of panels, by rule.
struct Column {
  Panel::Axes axes;
  std::vector<Points> curves;
};

/// A row of panels for each group of rules; a column has a common scale.
void drawRows(const std::string& path, const std::string& title, std::vector<Column> columns,
              const std::vector<std::string>& rules) {
  const std::vector<std::vector<size_t>> groups = curveGroups(rules);
  const double panel = (kWidth - 20.0) / static_cast<double>(columns.size()) - kLeft;
  Picture picture(static_cast<int>(kWidth),
                  static_cast<int>(50.0 + kRow * static_cast<double>(groups.size())), title);
  for (Column& column : columns)
    if (column.axes.y_max <= column.axes.y_min) column.axes.y_max = 1.08 * largest(column.curves);
  for (size_t row = 0; row < groups.size(); ++row) {
    const double top = 50.0 + kRow * static_cast<double>(row);
    drawLegend(picture, kLeft, top, rules, groups[row]);
    for (size_t i = 0; i < columns.size(); ++i) {
      const double left = kLeft + static_cast<double>(i) * (panel + kLeft);
      drawCurves(picture, {left, top + 45.0, panel, kRow - 115.0}, columns[i].axes,
                 columns[i].curves, rules, groups[row]);
    }
  }
  picture.save(path);
}

/// value(errors of an execution, rule) over the execution number, by rule.
template <class Value>
std::vector<Points> overExecutions(const TransitionErrors& transition, size_t rules,
                                   const Value& value) {
  std::vector<Points> curves(rules);
  for (size_t j = 0; j < transition.development.size(); ++j)
    for (size_t i = 0; i < rules; ++i)
      curves[i].emplace_back(static_cast<double>(j + 1), value(transition.development[j], i));
  return curves;
}

Points density(const Histogram& histogram) {
  double all = 0.0;
  for (const double count : histogram.counts) all += count;
  Points curve;
  for (size_t bin = 0; bin < histogram.counts.size() && all > 0.0; ++bin)
    curve.emplace_back((static_cast<double>(bin) + 0.5) * histogram.width,
                       100.0 * histogram.counts[bin] / all);
  return curve;
}

}  // namespace

size_t transitionOfFigures(const ExperimentErrors& errors, const ExperimentSettings& settings,
                           const std::vector<TrialGround>& grounds) {
  const size_t off = settings.ruleIndex("off"), omniscient = settings.ruleIndex(kOmniscient);
  size_t best = 0;
  double most = 0.0;
  for (size_t t = 0; t < errors.transitions.size(); ++t) {
    const TransitionErrors& transition = errors.transitions[t];
    if (grounds[transition.from].surface == "cinder" && grounds[transition.to].surface == "grass")
      return t;
    if (std::max(off, omniscient) == settings.rules.size()) continue;
    const MethodErrors& sums = transition.sequences.errors;
    const double ratio =
        sums.position.ratio(off, omniscient).value + sums.orientation.ratio(off, omniscient).value;
    if (ratio > most) {
      most = ratio;
      best = t;
    }
  }
  return best;
}

std::string wordsOf(const TransitionErrors& transition, const std::vector<TrialGround>& grounds) {
  return grounds[transition.from].surface + " to " + grounds[transition.to].surface;
}

void drawDevelopment(const std::string& path, const TransitionErrors& transition,
                     const ExperimentSettings& settings, const std::string& words) {
  const double last = static_cast<double>(transition.development.size());
  const size_t rules = settings.rules.size();
  std::vector<Column> columns;
  for (const bool position : {true, false}) {
    const auto of = [position](const MethodErrors& errors) -> const RatioMoments& {
      return position ? errors.position : errors.orientation;
    };
    const std::string name = position ? "Position" : "Orientation";
    const std::string unit = position ? "[m/m]" : "[rad/rad]";
    const auto axes = [&](const std::string& title) {
      return Panel::Axes{title, "execution after the change", unit, 1.0, last, 0.0, 0.0};
    };
    columns.push_back(
        {axes(name + " error"),
         overExecutions(transition, rules, [&](const MethodErrors& errors, size_t rule) {
           return of(errors).error(rule).value;
         })});
    columns.push_back(
        {axes("... its deviation"),
         overExecutions(transition, rules, [&](const MethodErrors& errors, size_t rule) {
           return of(errors).deviation(rule);
         })});
  }
  drawRows(path, "From " + words + ": error over executions, without a reset", std::move(columns),
           settings.rules);
}

void drawDistributions(const std::string& path, const TransitionErrors& transition,
                       const ExperimentSettings& settings, const std::string& words) {
  std::vector<Column> columns;
  for (const bool position : {true, false}) {
    const std::vector<Histogram>& histograms =
        position ? transition.sequences.position : transition.sequences.orientation;
    Column column;
    column.axes = {position ? "Position" : "Orientation",
                   position ? "error per driven metre [m/m]" : "error per radian [rad/rad]",
                   "executions [%]",
                   0.0,
                   histograms.front().width * static_cast<double>(histograms.front().counts.size()),
                   0.0,
                   0.0};
    for (const Histogram& histogram : histograms) column.curves.push_back(density(histogram));
    columns.push_back(std::move(column));
  }
  drawRows(path, "From " + words + ": errors over the test sequences", std::move(columns),
           settings.rules);
}

void drawDrift(const std::string& path, const std::vector<std::vector<double>>& drift,
               const ExperimentSettings& settings, const std::string& watched) {
  std::vector<Points> curves;
  for (const std::vector<double>& widths : drift) {
    Points curve;
    for (size_t j = 0; j < widths.size(); ++j)
      curve.emplace_back(static_cast<double>(j), widths[j]);
    curves.push_back(std::move(curve));
  }
  Panel::Axes axes{"", "execution", "width over the shipped one [1]"};
  axes.x_max = static_cast<double>(settings.drift);
  axes.y_max = 1.08 * largest(curves);
  const std::vector<std::vector<size_t>> groups = curveGroups(settings.rules);
  Picture picture(static_cast<int>(kWidth), static_cast<int>(50.0 + kRow),
                  "Drift on unchanged ground: width of '" + watched + "', which is never executed");
  const double panel = (kWidth - 20.0) / static_cast<double>(groups.size()) - kLeft;
  for (size_t i = 0; i < groups.size(); ++i) {
    const double left = kLeft + static_cast<double>(i) * (panel + kLeft);
    drawLegend(picture, left, 55.0, settings.rules, groups[i]);
    drawCurves(picture, {left, 80.0, panel, kRow - 100.0}, axes, curves, settings.rules, groups[i]);
  }
  picture.save(path);
}

}  // namespace tread::experiment
