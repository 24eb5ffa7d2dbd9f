// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

namespace tread::report {

/// A point of a chart, in the units of its axes.
struct ChartPoint {
  double x = 0.0;
  double y = 0.0;
};

/// Colour between blue (-1), white (0) and orange (1).
std::string divergingColour(double share);

/// Limits of the axes.
struct ChartRange {
  double x_min = 0.0;
  double x_max = 1.0;
  double y_min = 0.0;
  double y_max = 1.0;

  double height() const { return y_max - y_min; }
  void include(const ChartPoint& point);
  /// An empty range.
  static ChartRange empty();
  /// The same with margins, at least `least` wide; with equal scales for a plot of that shape.
  ChartRange widened(double least) const;
  ChartRange withEqualScales() const;
};

/// A small chart with axes as SVG text: 320 x 230 units, scaled to the width of its container.
/** Points that are not finite are left out; an axis without label has no numbers. Uses only shapes
 * and text with attributes of their own, so that it is also a valid file by itself. */
class Chart {
 public:
  Chart(std::string title, std::string x_words, std::string y_words, const ChartRange& range);

  void line(const std::vector<ChartPoint>& points, const std::string& colour, double width = 1.6,
            bool dashed = false);
  /// The area between low and high at each x.
  void band(const std::vector<ChartPoint>& low, const std::vector<ChartPoint>& high,
            const std::string& colour);
  /// The region within a radius of each point of a path; for charts with equal scales.
  void tube(const std::vector<ChartPoint>& points, const std::vector<double>& radii,
            const std::string& colour);
  /// A spot of a map, in its own colour.
  void spot(const ChartPoint& at, const std::string& fill);
  void dot(const ChartPoint& at, const std::string& colour, bool filled = true);
  /// From low to high at x.
  void bar(double x, double low, double high, const std::string& colour);
  /// A filled rectangle between two corners.
  void field(const ChartPoint& corner, const ChartPoint& opposite, const std::string& colour);
  /// Text centred at a place just below the axis.
  void labelBelow(double x, const std::string& words);
  /// A horizontal line at y.
  void level(double y);
  /// One entry of the legend below the title.
  void legend(const std::string& words, const std::string& colour, bool dashed = false);

  const ChartRange& range() const { return range_; }
  std::string svg() const;

 private:
  double px(double x) const;
  double py(double y) const;
  std::string axes() const;

  std::string title_;
  std::string x_words_;
  std::string y_words_;
  ChartRange range_;
  std::string shapes_;
  std::string legend_;
  double legend_end_ = 0.0;
};

/// Charts in rows of `columns`, as one SVG file.
std::string sheetOf(const std::vector<std::string>& charts, size_t columns);

}  // namespace tread::report
