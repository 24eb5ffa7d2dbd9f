// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors

#include "tools/lab/gap/report/pictures.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "common/statistics/statistics.hpp"
#include "tools/lab/gap/report/words.hpp"

namespace tread::gap {

using namespace report;

namespace {

double middle(const AtlasCell& cell) {
  return 0.5 * (cell.from + cell.to);
}

/// Means, bands and dots of one row of cells; skips empty cells.
void draw(Chart& chart, const std::vector<AtlasCell>& cells, const char* colour, bool dashed) {
  std::vector<ChartPoint> low, mean, high;
  for (const AtlasCell& cell : cells) {
    if (cell.rows == 0) continue;
    low.push_back({middle(cell), cell.low});
    mean.push_back({middle(cell), cell.mean});
    high.push_back({middle(cell), cell.high});
  }
  chart.band(low, high, colour);
  chart.line(mean, colour, 1.6, dashed);
  for (const AtlasCell& cell : cells) {
    if (cell.rows == 0) continue;
    chart.bar(middle(cell), cell.low, cell.high, colour);
    chart.dot({middle(cell), cell.mean}, colour, cell.marked);
  }
}

void include(ChartRange& range, const std::vector<AtlasCell>& cells) {
  for (const AtlasCell& cell : cells) {
    if (cell.rows == 0) continue;
    range.include({middle(cell), cell.mean});
    range.include({middle(cell), cell.low});
    range.include({middle(cell), cell.high});
  }
}

/// Length of the heading mark at a path's end, relative to the height of the picture.
constexpr double kTip = 0.1;

/// A point ahead of a pose.
ChartPoint headingTip(const Pose2& pose, double length) {
  return {-pose.y - length * std::sin(pose.yaw), pose.x + length * std::cos(pose.yaw)};
}

/// Ahead is up, left is left.
std::vector<ChartPoint> seenFromAbove(const std::vector<Pose2>& poses) {
  std::vector<ChartPoint> points;
  points.reserve(poses.size());
  for (const Pose2& pose : poses) points.push_back({-pose.y, pose.x});
  return points;
}

}  // namespace

std::string atlasPicture(const AtlasCurve& curve) {
  ChartRange range = ChartRange::empty();
  include(range, curve.before);
  include(range, curve.after);
  range.include({range.x_min, 0.0});
  Chart chart(
      curve.channel + " over " + curve.variable,
      curve.variable + (curve.variable_unit.empty() ? "" : " [" + curve.variable_unit + "]"),
      "measured - predicted [" + curve.unit + "]", range.widened(1e-3));
  chart.level(0.0);
  draw(chart, curve.before, kBeforeColour, true);
  draw(chart, curve.after, kAfterColour, false);
  chart.legend("before", kBeforeColour, true);
  chart.legend("after", kAfterColour);
  return chart.svg();
}

std::string termPicture(const UnnamedTerm& term, const UnnamedFinding& found) {
  std::vector<ChartPoint> low, curve, high;
  ChartRange range = ChartRange::empty();
  for (size_t i = 0; i < term.at.size(); ++i) {
    const double deviation = i < found.deviations.size() ? found.deviations[i] : 0.0;
    const double half = std::isfinite(deviation) ? 1.96 * deviation : 0.0;
    low.push_back({term.at[i], term.values[i] - half});
    curve.push_back({term.at[i], term.values[i]});
    high.push_back({term.at[i], term.values[i] + half});
    range.include(low.back());
    range.include(high.back());
  }
  for (const AtlasCell& cell : found.data)
    if (cell.rows > 0) range.include({middle(cell), cell.mean});
  range.include({range.x_min, 0.0});
  const std::string times = term.times == nullptr ? "" : std::string(", times ") + term.times->name;
  Chart chart(
      found.name + ": " + termChannelName(term.channel) + " by " + term.condition->name + times,
      std::string(term.condition->name) + " [" + term.condition->unit + "]",
      "beside the model [" + termCurveUnit(term) + "]", range.widened(1e-3));
  chart.level(0.0);
  chart.band(low, high, kAfterColour);
  chart.line(curve, kAfterColour, 1.6, false);
  for (const AtlasCell& cell : found.data)
    if (cell.rows > 0) chart.dot({middle(cell), cell.mean}, kBeforeColour, true);
  chart.legend("measured", kBeforeColour, true);
  chart.legend("term", kAfterColour);
  return chart.svg();
}

Pictures restPictures(const GapFinding& finding) {
  constexpr size_t kMost = 3;
  Pictures rest{
      {},
      "Residuals over the variables that they depend on. Orange, dashed: the old model. Blue: "
      "the new one, which should lie on 0."};
  for (const AtlasCurve& curve : finding.atlas.curves)
    if (curve.unexplained && rest.svg.size() < kMost) rest.svg.push_back(atlasPicture(curve));
  return rest;
}

double largestResidual(const AtlasMap& map) {
  double largest = 0.0;
  for (const std::vector<double>* values : {&map.before, &map.after})
    for (const double value : *values)
      if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
  return largest;
}

std::string mapPicture(const AtlasMap& map, bool after, double full_colour) {
  const std::vector<double>& values = after ? map.after : map.before;
  const ChartRange range{map.v_edges.front(), map.v_edges.back(), map.omega_edges.front(),
                         map.omega_edges.back()};
  Chart chart(map.channel + (after ? ", after" : ", before") +
                  ": full colour = " + threeDigits(full_colour) + " " + map.unit,
              "speed [m/s]", "yaw rate [rad/s]", range);
  const size_t columns = map.v_edges.size() - 1;
  for (size_t i = 0; i < values.size(); ++i) {
    const size_t column = i % columns;
    const size_t row = i / columns;
    if (!std::isfinite(values[i]) || row + 1 >= map.omega_edges.size()) continue;
    chart.field({map.v_edges[column], map.omega_edges[row]},
                {map.v_edges[column + 1], map.omega_edges[row + 1]},
                divergingColour(full_colour > 0.0 ? values[i] / full_colour : 0.0));
  }
  chart.legend("more than predicted", kBeforeColour);
  chart.legend("less", kAfterColour);
  return chart.svg();
}

void drawPath(Chart& chart, const std::vector<Pose2>& poses, const char* colour, bool dashed) {
  const std::vector<ChartPoint> points = seenFromAbove(poses);
  if (points.empty()) return;
  chart.line(points, colour, 1.8, dashed);
  chart.line({points.back(), headingTip(poses.back(), kTip * chart.range().height())}, colour, 2.4);
  chart.dot(points.back(), colour);
}

ChartRange rangeOf(const std::vector<const std::vector<Pose2>*>& paths) {
  ChartRange range = ChartRange::empty();
  for (const std::vector<Pose2>* poses : paths)
    for (const ChartPoint& point : seenFromAbove(*poses)) range.include(point);
  const double height = range.widened(0.2).withEqualScales().height();
  for (const std::vector<Pose2>* poses : paths)
    if (!poses->empty()) range.include(headingTip(poses->back(), kTip * height));
  return range.widened(0.2).withEqualScales();
}

std::string overlayPicture(const Overlay& overlay, const std::string& title) {
  ChartRange range = rangeOf({&overlay.measured, &overlay.before, &overlay.after});
  const std::vector<ChartPoint> predicted = seenFromAbove(overlay.after);
  for (size_t i = 0; i < std::min(predicted.size(), overlay.band.size()); ++i)
    for (const double side : {-1.1, 1.1})
      range.include(
          {predicted[i].x + side * overlay.band[i], predicted[i].y + side * overlay.band[i]});
  Chart chart(title, "to the right [m]", "ahead [m]", range.withEqualScales());
  chart.tube(predicted, overlay.band, kAfterColour);
  drawPath(chart, overlay.measured, kInk, false);
  drawPath(chart, overlay.before, kBeforeColour, true);
  drawPath(chart, overlay.after, kAfterColour, false);
  chart.legend("measured", kInk);
  chart.legend("old " + saidDistance(overlay.error_before), kBeforeColour, true);
  chart.legend("new " + saidDistance(overlay.error_after), kAfterColour);
  return chart.svg();
}

double fullColourOf(const std::vector<PlaceError>& places) {
  std::vector<double> errors;
  for (const PlaceError& place : places) {
    errors.push_back(place.before);
    errors.push_back(place.after);
  }
  return lowerQuantile(std::move(errors), 0.95, 0.0);
}

std::string placePicture(const std::vector<PlaceError>& places, bool after, double full_colour,
                         const std::string& log) {
  const auto errorOf = [after](const PlaceError& place) {
    return after ? place.after : place.before;
  };
  std::vector<PlaceError> order = places;  // the largest errors on top
  std::stable_sort(order.begin(), order.end(), [&](const PlaceError& a, const PlaceError& b) {
    return errorOf(a) < errorOf(b);
  });
  ChartRange range = ChartRange::empty();
  for (const PlaceError& place : order) range.include({place.x, place.y});
  Chart chart(std::string("end errors ") + (after ? "after, " : "before, ") + log, "x [m]", "y [m]",
              range.widened(1.0).withEqualScales());
  for (const PlaceError& place : order)
    chart.spot({place.x, place.y},
               divergingColour(full_colour > 0.0 ? errorOf(place) / full_colour : 0.0));
  chart.legend("full colour: " + saidDistance(full_colour) + " and more", kBeforeColour);
  return chart.svg();
}

std::string stepsPicture(const std::vector<SearchStep>& steps) {
  ChartRange range = ChartRange::empty();
  range.include({0.5, 0.0});
  range.include({0.5 + static_cast<double>(steps.size()), 0.0});
  for (size_t i = 0; i < steps.size(); ++i)
    for (const double side : {-1.0, 1.0})
      range.include({static_cast<double>(i) + 1.0, steps[i].gain + side * steps[i].gain_error});
  Chart chart("gain of each step on blocks that were not fitted", "", "gain [nats]",
              range.widened(1.0));
  chart.level(0.0);
  for (size_t i = 0; i < steps.size(); ++i) {
    const SearchStep& step = steps[i];
    const double x = static_cast<double>(i) + 1.0;
    chart.field({x - 0.3, 0.0}, {x + 0.3, step.gain}, step.removed ? kGreyInk : kAfterColour);
    chart.bar(x, step.gain - step.gain_error, step.gain + step.gain_error, kInk);
    chart.labelBelow(x, std::to_string(i + 1));
  }
  chart.legend("added", kAfterColour);
  chart.legend("removed or refused", kGreyInk);
  return chart.svg();
}

std::string gapPicture(const Gap& gap, bool yaw) {
  const double factor = yaw ? 180.0 / kPi : 1.0;
  const auto median = [&](const EndErrors& errors) {
    return factor * (yaw ? errors.yaw.median : errors.position.median);
  };
  const double before = median(gap.before);
  const double after = median(gap.after);
  ChartRange range{0.4, gap.floor ? 3.6 : 2.6, 0.0, 1.15 * std::max(before, after)};
  if (gap.floor) range.y_max = std::max(range.y_max, 1.15 * median(*gap.floor));
  if (!(range.y_max > 0.0)) range.y_max = 1.0;
  Chart chart(std::string(yaw ? "heading" : "position") + " error after " +
                  threeDigits(gap.horizon) + " s, median",
              "", yaw ? "deg" : "m", range);
  chart.field({0.7, 0.0}, {1.3, before}, kBeforeColour);
  chart.field({1.7, 0.0}, {2.3, after}, kAfterColour);
  if (gap.floor) chart.field({2.7, 0.0}, {3.3, median(*gap.floor)}, kGreyInk);
  chart.labelBelow(1.0, "before");
  chart.labelBelow(2.0, "after");
  // No floor if the model is below it.
  const std::string floor = gap.floor && after < median(*gap.floor) ? "dead reckoning" : "floor";
  if (gap.floor) chart.labelBelow(3.0, floor);
  chart.legend("before " + threeDigits(before), kBeforeColour);
  chart.legend("after " + threeDigits(after), kAfterColour);
  if (gap.floor) chart.legend(floor + " " + threeDigits(median(*gap.floor)), kGreyInk);
  return chart.svg();
}

namespace {

/// Cells with a significant residual.
size_t marked(const std::vector<AtlasCell>& cells) {
  return static_cast<size_t>(
      std::count_if(cells.begin(), cells.end(), [](const AtlasCell& cell) { return cell.marked; }));
}

std::vector<std::string> mapPictures(const GapFinding& finding) {
  std::vector<std::string> pictures;
  for (const AtlasMap& map : finding.atlas.maps) {
    if (map.v_edges.size() < 2 || map.omega_edges.size() < 2) continue;
    const double full_colour = largestResidual(map);
    pictures.push_back(mapPicture(map, false, full_colour));
    pictures.push_back(mapPicture(map, true, full_colour));
  }
  return pictures;
}

/// Names of logs in the order of the drives; the model is not one.
std::string logName(const std::vector<InputFile>& inputs, size_t drive) {
  std::vector<std::string> names;
  for (const InputFile::Role role : {InputFile::Role::kTrain, InputFile::Role::kTest})
    for (const InputFile& input : inputs)
      if (input.role == role) names.push_back(input.name);
  if (drive >= names.size()) return "log " + std::to_string(drive + 1);
  constexpr size_t kRoom = 26;
  const std::string name = names[drive].substr(0, names[drive].rfind(".lcmlog"));
  return name.size() <= kRoom ? name : name.substr(0, kRoom - 2) + "..";
}

/// Error maps, one per log, before and after in the same colours.
std::vector<std::string> placePictures(const GapFinding& finding,
                                       const std::vector<InputFile>& inputs) {
  std::map<size_t, std::vector<PlaceError>> logs;
  for (const PlaceError& place : finding.shown.places) logs[place.drive].push_back(place);
  std::vector<std::string> pictures;
  for (const auto& [drive, places] : logs) {
    const double full_colour = fullColourOf(places);
    for (const bool after : {false, true})
      pictures.push_back(placePicture(places, after, full_colour, logName(inputs, drive)));
  }
  return pictures;
}

/// Which model predicted the shown executions.
std::string predictedBy(const GapFinding& finding, const std::vector<InputFile>& inputs) {
  if (std::any_of(inputs.begin(), inputs.end(),
                  [](const InputFile& input) { return input.role == InputFile::Role::kTest; }))
    return "they are of the test logs.";
  if (finding.gap && finding.gap->structure_nested)
    return "each is predicted by a model fitted to the other half of the driving.";
  return "each is predicted with parameters fitted to the other half of the driving; the effects "
         "were chosen with all driving.";
}

std::string remarkOf(const SearchStep& step) {
  std::vector<std::string> close;
  for (const RunnerUp& runner_up : step.runner_ups)
    if (runner_up.behind <= runner_up.error) close.push_back(shortTitleOf(runner_up.effect));
  std::string text = step.remark;
  if (!close.empty()) text += (text.empty() ? "as good: " : "; as good: ") + joined(close, "or");
  return text;
}

std::vector<Block> atlasBlocks(const GapFinding& finding) {
  if (finding.atlas.curves.empty()) return {};
  std::vector<Block> blocks;
  size_t before = 0;
  size_t after = 0;
  for (const AtlasCurve& curve : finding.atlas.curves) {
    before += marked(curve.before);
    after += marked(curve.after);
  }
  blocks.push_back(
      Paragraph{"Residuals, measured minus predicted, over what they may depend on. Of all cells " +
                std::to_string(before) + " were significant before and " + std::to_string(after) +
                " are now (filled dots: significant for so many cells; intervals: 95 % each, over "
                "blocks of driving)."});
  if (const std::vector<std::string> maps = mapPictures(finding); !maps.empty())
    blocks.push_back(Pictures{maps,
                              "Mean residual over speed and yaw rate; white is zero, "
                              "empty cells were not driven."});
  Pictures curves{{}, "Orange, dashed: the old model. Blue: the new one."};
  for (const AtlasCurve& curve : finding.atlas.curves) curves.svg.push_back(atlasPicture(curve));
  blocks.push_back(curves);
  return blocks;
}

std::vector<Block> executionsBlocks(const GapFinding& finding,
                                    const std::vector<InputFile>& inputs) {
  if (finding.shown.overlays.empty()) return {};
  std::vector<Block> blocks;
  constexpr size_t kTypical = 6;
  Pictures pictures{{},
                    "Each from its start; ahead is up. Dots: end positions with headings. "
                    "Blue shade: 9 of 10 are within."};
  for (size_t i = 0; i < finding.shown.overlays.size(); ++i) {
    const Overlay& overlay = finding.shown.overlays[i];
    const std::string rank = i < kTypical ? "typical" : "worst";
    pictures.svg.push_back(overlayPicture(overlay, rank + ", " + threeDigits(overlay.begin) +
                                                       " s of " + logName(inputs, overlay.drive)));
  }
  blocks.push_back(Paragraph{
      "Six typical executions, then the three with the largest errors, none used for the fit: " +
      predictedBy(finding, inputs)});
  if (!finding.shown.overlays.front().band.empty())
    blocks.push_back(
        Paragraph{"The shade is a 90 % band: the residual noise of the fitted model (for each "
                  "channel a constant part "
                  "and one in proportion to the motion), carried along the predicted "
                  "path, scaled to contain 9 of 10 of all " +
                  std::to_string(finding.shown.places.size()) + " such executions at each time."});
  blocks.push_back(pictures);
  return blocks;
}

std::vector<Block> placesBlocks(const GapFinding& finding, const std::vector<InputFile>& inputs) {
  if (!finding.gap) return {};
  if (finding.shown.places.empty())
    return {Paragraph{"No map: the logs have no absolute poses at the executions' ends."}};
  return {Pictures{
      placePictures(finding, inputs),
      "Position error at the end of each execution that was not used for the fit, where it was "
      "driven; grey is zero. Errors concentrated in one place point to the ground there."}};
}

std::vector<Block> stepsBlocks(const GapFinding& finding) {
  if (finding.search.steps.empty()) return {};
  std::vector<Block> blocks;
  blocks.push_back(Paragraph{
      "Each step adds the effect with the largest gain on blocks of driving that were not fitted, "
      "or "
      "removes one that the others make superfluous. Gains in log likelihood (nats) with "
      "standard error; p "
      "is the probability of such a score anywhere in the catalogue without any effect."});
  Table table{{"step", "effect", "remark", "score", "p", "gain"}, {}, 3};
  size_t number = 0;
  for (const SearchStep& step : finding.search.steps) {
    const std::string sign = step.removed ? "- " : "+ ";
    table.rows.push_back({std::to_string(++number), sign + titleOf(step.effect), remarkOf(step),
                          threeDigits(step.score), saidChance(step.p_value),
                          threeDigits(step.gain) + " \u00b1 " + threeDigits(step.gain_error)});
  }
  blocks.push_back(table);
  blocks.push_back(Pictures{{stepsPicture(finding.search.steps)}, "Gain of each step."});
  return blocks;
}

}  // namespace

std::vector<Section> evidenceSections(const GapFinding& finding,
                                      const std::vector<InputFile>& inputs) {
  return {{"Where simulation and measurement disagree", atlasBlocks(finding)},
          {"Executions, as measured and as predicted", executionsBlocks(finding, inputs)},
          {"Where on the ground", placesBlocks(finding, inputs)},
          {"Step by step", stepsBlocks(finding)}};
}

}  // namespace tread::gap
