// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/report/pictures.hpp"

#include <algorithm>
#include <cmath>

#include "tools/gap/report/words.hpp"

namespace tread::gap {

using namespace report;

namespace {

double middle(const AtlasCell& cell) {
  return 0.5 * (cell.from + cell.to);
}

/// Means, bands and dots of one row of cells; cells without rows are left out.
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

/// Length of the heading at a path's end over the height of its picture.
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
  if (errors.empty()) return 0.0;
  const auto at =
      errors.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(errors.size() - 1));
  std::nth_element(errors.begin(), at, errors.end());
  return *at;
}

std::string placePicture(const std::vector<PlaceError>& places, bool after, double full_colour,
                         const std::string& log) {
  const auto errorOf = [after](const PlaceError& place) {
    return after ? place.after : place.before;
  };
  std::vector<PlaceError> order = places;  // the worst on top
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
  // No floor where the model is below it.
  const std::string floor = gap.floor && after < median(*gap.floor) ? "dead reckoning" : "floor";
  if (gap.floor) chart.labelBelow(3.0, floor);
  chart.legend("before " + threeDigits(before), kBeforeColour);
  chart.legend("after " + threeDigits(after), kAfterColour);
  if (gap.floor) chart.legend(floor + " " + threeDigits(median(*gap.floor)), kGreyInk);
  return chart.svg();
}

}  // namespace tread::gap
