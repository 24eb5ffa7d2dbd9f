// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/experiment/figures.hpp"

#include <algorithm>
#include <map>

#include "tools/experiment/tables.hpp"
#include "tools/picture/plot.hpp"

namespace tread::experiment {
namespace {

using picture::Box;
using picture::Panel;
using picture::Picture;
using picture::Style;
using Points = std::vector<Eigen::Vector2d>;

constexpr int kWidth = 1160;
constexpr double kPanelWidth = 480.0;
constexpr double kLeft[] = {70.0, 650.0};

Style styleOf(const std::string& rule) {
  static const std::map<std::string, picture::Colour> colours{{"off", picture::kGrey},
                                                              {"single", picture::kBlue},
                                                              {"collective", picture::kRed},
                                                              {"telescoping", picture::kPink},
                                                              {"local_filter", picture::kOrange},
                                                              {"bank", picture::kGreen},
                                                              {kBankUnseen, picture::kSkyBlue},
                                                              {kOmniscient, picture::kBlack}};
  const auto colour = colours.find(rule);
  Style style;
  style.colour = colour == colours.end() ? picture::kBlack : colour->second;
  style.dashed = rule == "off" || rule == kOmniscient;
  // Collective and telescoping scaling are often the same to a line's width: both show.
  style.width = style.dashed ? 1.5 : rule == "telescoping" ? 5.0 : 2.0;
  return style;
}

/// Names of the rules in a line below the title, away from the curves.
void drawLegend(Picture& picture, const std::vector<std::string>& rules) {
  double x = kLeft[0];
  for (const std::string& rule : rules) {
    const Style style = styleOf(rule);
    const double height = std::max(2.0, style.width);
    picture.fill({x, 47.0, style.dashed ? 9.0 : 26.0, height}, style.colour);
    if (style.dashed) picture.fill({x + 15.0, 47.0, 9.0, height}, style.colour);
    picture.text(x + 32.0, 52.0, rule, 12.0);
    x += 60.0 + 7.5 * static_cast<double>(rule.size());
  }
}

double largest(const std::vector<Points>& curves) {
  double y = 0.0;
  for (const Points& curve : curves)
    for (const Eigen::Vector2d& point : curve) y = std::max(y, point.y());
  return y;
}

/// One panel with a curve for each rule.
void drawCurves(Picture& picture, Box box, Panel::Axes axes, const std::vector<Points>& curves,
                const std::vector<std::string>& rules) {
  axes.y_max = 1.08 * largest(curves);
  Panel panel(picture, box, axes);
  for (const bool wide : {true, false})
    for (size_t i = 0; i < curves.size(); ++i)
      if (!curves[i].empty() && (styleOf(rules[i]).width > 2.0) == wide)
        panel.line(curves[i], styleOf(rules[i]));
  panel.finish();
}

/// value(errors of an execution, rule) over the number of the execution, by rule.
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
                           const std::vector<Ground>& grounds) {
  const size_t off = settings.ruleIndex("off"), omniscient = settings.ruleIndex(kOmniscient);
  size_t best = 0;
  double most = 0.0;
  for (size_t t = 0; t < errors.transitions.size(); ++t) {
    const TransitionErrors& transition = errors.transitions[t];
    if (grounds[transition.from].surface == "cinder" && grounds[transition.to].surface == "grass")
      return t;
    if (std::max(off, omniscient) == settings.rules.size()) continue;
    const Errors& sums = transition.sequences.errors;
    const double ratio =
        sums.position.ratio(off, omniscient).value + sums.orientation.ratio(off, omniscient).value;
    if (ratio > most) {
      most = ratio;
      best = t;
    }
  }
  return best;
}

std::string wordsOf(const TransitionErrors& transition, const std::vector<Ground>& grounds) {
  return grounds[transition.from].surface + " to " + grounds[transition.to].surface;
}

void drawDevelopment(const std::string& path, const TransitionErrors& transition,
                     const ExperimentSettings& settings, const std::string& words) {
  Picture picture(kWidth, 785, "From " + words + ": error over executions, without a reset");
  drawLegend(picture, settings.rules);
  const double last = static_cast<double>(transition.development.size());
  const char* units[] = {"per driven metre [m/m]", "per radian turned [rad/rad]"};
  for (int column = 0; column < 2; ++column) {
    const auto of = [&](const Errors& errors) -> const RatioMoments& {
      return column == 0 ? errors.position : errors.orientation;
    };
    const std::string name = column == 0 ? "Position" : "Orientation";
    Panel::Axes axes{name + " error", "execution after the change", units[column], 1.0, last};
    drawCurves(picture, {kLeft[column], 95.0, kPanelWidth, 270.0}, axes,
               overExecutions(
                   transition, settings.rules.size(),
                   [&](const Errors& errors, size_t rule) { return of(errors).error(rule).value; }),
               settings.rules);
    axes.title = name + " error: standard deviation";
    drawCurves(picture, {kLeft[column], 460.0, kPanelWidth, 270.0}, axes,
               overExecutions(
                   transition, settings.rules.size(),
                   [&](const Errors& errors, size_t rule) { return of(errors).deviation(rule); }),
               settings.rules);
  }
  picture.save(path);
}

void drawDistributions(const std::string& path, const TransitionErrors& transition,
                       const ExperimentSettings& settings, const std::string& words) {
  Picture picture(kWidth, 450, "From " + words + ": errors over the test sequences");
  drawLegend(picture, settings.rules);
  for (int column = 0; column < 2; ++column) {
    const std::vector<Histogram>& histograms =
        column == 0 ? transition.sequences.position : transition.sequences.orientation;
    std::vector<Points> curves;
    for (const Histogram& histogram : histograms) curves.push_back(density(histogram));
    Panel::Axes axes{column == 0 ? "Position" : "Orientation",
                     column == 0 ? "error per driven metre [m/m]" : "error per radian [rad/rad]",
                     "executions [%]"};
    axes.x_max = histograms.front().width * static_cast<double>(histograms.front().counts.size());
    drawCurves(picture, {kLeft[column], 95.0, kPanelWidth, 300.0}, axes, curves, settings.rules);
  }
  picture.save(path);
}

}  // namespace tread::experiment
