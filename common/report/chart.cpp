// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/report/chart.hpp"

#include "common/report/page.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/report/text.hpp"

namespace tread::report {
namespace {

constexpr double kChartWidth = 320.0;
constexpr double kHeight = 230.0;
constexpr double kLeft = 44.0;
constexpr double kRight = 8.0;
constexpr double kTop = 40.0;
constexpr double kBottom = 36.0;

/// Tenths of a unit are finer than any screen.
std::string at(double value) {
  std::string text = fixed(value, 1);
  return text == "-0.0" ? "0.0" : text;
}

std::string words(double x, double y, const std::string& text, const std::string& more) {
  return "<text x=\"" + at(x) + "\" y=\"" + at(y) + "\" " + more + ">" + escaped(text) + "</text>";
}

std::string stroke(double x1, double y1, double x2, double y2, const std::string& colour,
                   const std::string& more = "") {
  return "<line x1=\"" + at(x1) + "\" y1=\"" + at(y1) + "\" x2=\"" + at(x2) + "\" y2=\"" + at(y2) +
         "\" stroke=\"" + colour + "\"" + more + "/>";
}

bool isFinite(const ChartPoint& point) {
  return std::isfinite(point.x) && std::isfinite(point.y);
}

}  // namespace

std::string divergingColour(double share) {
  const double s = std::isfinite(share) ? std::clamp(share, -1.0, 1.0) : 0.0;
  const double full[3] = {s < 0.0 ? 31.0 : 208.0, s < 0.0 ? 111.0 : 102.0, s < 0.0 ? 178.0 : 28.0};
  int rgb[3];
  for (int i = 0; i < 3; ++i)
    rgb[i] = static_cast<int>(std::lround(245.0 + std::abs(s) * (full[i] - 245.0)));
  return formatted("#%02x%02x%02x", rgb[0], rgb[1], rgb[2]);
}

ChartRange ChartRange::empty() {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  return {kFar, -kFar, kFar, -kFar};
}

void ChartRange::include(const ChartPoint& point) {
  if (!isFinite(point)) return;
  x_min = std::min(x_min, point.x);
  x_max = std::max(x_max, point.x);
  y_min = std::min(y_min, point.y);
  y_max = std::max(y_max, point.y);
}

ChartRange ChartRange::widened(double least) const {
  if (x_min > x_max) return {-least, least, -least, least};
  ChartRange wide = *this;
  const auto widen = [&](double& low, double& high) {
    const double middle = 0.5 * (low + high);
    const double half = std::max(0.54 * (high - low), 0.5 * least);
    low = middle - half;
    high = middle + half;
  };
  widen(wide.x_min, wide.x_max);
  widen(wide.y_min, wide.y_max);
  return wide;
}

ChartRange ChartRange::withEqualScales() const {
  const double per_x = (x_max - x_min) / (kChartWidth - kLeft - kRight);
  const double per_y = (y_max - y_min) / (kHeight - kTop - kBottom);
  const double grow_x = 0.5 * std::max(0.0, per_y - per_x) * (kChartWidth - kLeft - kRight);
  const double grow_y = 0.5 * std::max(0.0, per_x - per_y) * (kHeight - kTop - kBottom);
  return {x_min - grow_x, x_max + grow_x, y_min - grow_y, y_max + grow_y};
}

Chart::Chart(std::string title, std::string x_words, std::string y_words, const ChartRange& range)
    : title_(std::move(title)),
      x_words_(std::move(x_words)),
      y_words_(std::move(y_words)),
      range_(range),
      legend_end_(kLeft) {}

double Chart::px(double x) const {
  const double share = (x - range_.x_min) / (range_.x_max - range_.x_min);
  return kLeft + std::clamp(share, -0.5, 1.5) * (kChartWidth - kLeft - kRight);
}

double Chart::py(double y) const {
  const double share = (y - range_.y_min) / (range_.y_max - range_.y_min);
  return kHeight - kBottom - std::clamp(share, -0.5, 1.5) * (kHeight - kTop - kBottom);
}

void Chart::line(const std::vector<ChartPoint>& points, const std::string& colour, double width,
                 bool dashed) {
  std::string path;
  for (const ChartPoint& point : points)
    if (isFinite(point))
      path += (path.empty() ? "" : " ") + at(px(point.x)) + "," + at(py(point.y));
  if (path.empty()) return;
  shapes_ += "<polyline fill=\"none\" stroke=\"" + colour + "\" stroke-width=\"" + at(width) +
             "\" stroke-linejoin=\"round\"" + (dashed ? " stroke-dasharray=\"5 3\"" : "") +
             " points=\"" + path + "\"/>\n";
}

void Chart::band(const std::vector<ChartPoint>& low, const std::vector<ChartPoint>& high,
                 const std::string& colour) {
  std::string path;
  const auto add = [&](const ChartPoint& point) {
    if (isFinite(point))
      path += (path.empty() ? "" : " ") + at(px(point.x)) + "," + at(py(point.y));
  };
  for (const ChartPoint& point : low) add(point);
  for (auto point = high.rbegin(); point != high.rend(); ++point) add(*point);
  if (path.empty()) return;
  shapes_ += "<polygon fill=\"" + colour + "\" fill-opacity=\"0.16\" points=\"" + path + "\"/>\n";
}

void Chart::tube(const std::vector<ChartPoint>& points, const std::vector<double>& radii,
                 const std::string& colour) {
  const double scale = (kChartWidth - kLeft - kRight) / (range_.x_max - range_.x_min);
  std::string pieces;
  for (size_t i = 1; i < std::min(points.size(), radii.size()); ++i) {
    if (!isFinite(points[i - 1]) || !isFinite(points[i])) continue;
    pieces += stroke(
        px(points[i - 1].x), py(points[i - 1].y), px(points[i].x), py(points[i].y), colour,
        " stroke-linecap=\"round\" stroke-width=\"" + at(scale * (radii[i - 1] + radii[i])) + "\"");
  }
  // Opacity applies to the group: overlapping pieces would darken one another.
  if (!pieces.empty()) shapes_ += "<g opacity=\"0.16\">" + pieces + "</g>\n";
}

void Chart::spot(const ChartPoint& point, const std::string& fill) {
  if (!isFinite(point)) return;
  shapes_ += "<circle cx=\"" + at(px(point.x)) + "\" cy=\"" + at(py(point.y)) +
             "\" r=\"3\" stroke=\"#8a949e\" stroke-width=\"0.4\" fill=\"" + fill + "\"/>\n";
}

void Chart::dot(const ChartPoint& point, const std::string& colour, bool filled) {
  if (!isFinite(point)) return;
  shapes_ += "<circle cx=\"" + at(px(point.x)) + "\" cy=\"" + at(py(point.y)) +
             "\" r=\"2.6\" stroke=\"" + colour + "\" fill=\"" + (filled ? colour : "#fff") +
             "\"/>\n";
}

void Chart::bar(double x, double low, double high, const std::string& colour) {
  if (!std::isfinite(x) || !std::isfinite(low) || !std::isfinite(high)) return;
  shapes_ += stroke(px(x), py(low), px(x), py(high), colour, " stroke-width=\"1.2\"") + "\n";
}

void Chart::field(const ChartPoint& corner, const ChartPoint& opposite, const std::string& colour) {
  const double left = std::min(px(corner.x), px(opposite.x));
  const double top = std::min(py(corner.y), py(opposite.y));
  shapes_ += "<rect x=\"" + at(left) + "\" y=\"" + at(top) + "\" width=\"" +
             at(std::abs(px(corner.x) - px(opposite.x))) + "\" height=\"" +
             at(std::abs(py(corner.y) - py(opposite.y))) + "\" fill=\"" + colour + "\"/>\n";
}

void Chart::labelBelow(double x, const std::string& label) {
  shapes_ += words(px(x), kHeight - kBottom + 13.0, label,
                   "text-anchor=\"middle\" font-size=\"10\" fill=\"#1c2126\"") +
             "\n";
}

void Chart::level(double y) {
  if (y < range_.y_min || y > range_.y_max) return;
  shapes_ +=
      stroke(kLeft, py(y), kChartWidth - kRight, py(y), kGreyInk, " stroke-width=\"0.8\"") + "\n";
}

void Chart::legend(const std::string& entry, const std::string& colour, bool dashed) {
  const double x = legend_end_;
  legend_ +=
      stroke(x, 27.0, x + 14.0, 27.0, colour,
             std::string(" stroke-width=\"2.2\"") + (dashed ? " stroke-dasharray=\"5 3\"" : "")) +
      words(x + 18.0, 30.5, entry, "font-size=\"10\" fill=\"#1c2126\"") + "\n";
  legend_end_ += 30.0 + 5.4 * static_cast<double>(entry.size());
}

std::string Chart::axes() const {
  const double bottom = kHeight - kBottom;
  std::string text;
  const double step_x = tickStep(range_.x_max - range_.x_min, 6);
  for (const double tick : ticks(range_.x_min, range_.x_max, step_x)) {
    if (x_words_.empty()) break;
    text += stroke(px(tick), kTop, px(tick), bottom, "#e8ebee") +
            words(px(tick), bottom + 12.0, tickText(tick, step_x), "text-anchor=\"middle\"") + "\n";
  }
  const double step_y = tickStep(range_.y_max - range_.y_min, 5);
  for (const double tick : ticks(range_.y_min, range_.y_max, step_y))
    text += stroke(kLeft, py(tick), kChartWidth - kRight, py(tick), "#e8ebee") +
            words(kLeft - 4.0, py(tick) + 3.0, tickText(tick, step_y), "text-anchor=\"end\"") +
            "\n";
  return text;
}

std::string Chart::svg() const {
  const std::string small = "font-size=\"9\" fill=\"#5a646e\"";
  const double bottom = kHeight - kBottom;
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 320 230\" role=\"img\" "
         "font-family=\"system-ui, sans-serif\"><title>" +
         escaped(title_) + "</title>\n<rect width=\"320\" height=\"230\" fill=\"#fff\"/>\n" +
         words(4.0, 13.0, title_, "font-size=\"11.5\" font-weight=\"600\" fill=\"#1c2126\"") +
         "\n" + legend_ + "<g " + small + ">\n" + axes() +
         words(0.5 * (kLeft + kChartWidth - kRight), kHeight - 8.0, x_words_,
               "text-anchor=\"middle\" font-size=\"10\"") +
         words(0.0, 0.0, y_words_,
               "text-anchor=\"middle\" font-size=\"10\" transform=\"translate(10 " +
                   at(0.5 * (kTop + bottom)) + ") rotate(-90)\"") +
         "</g>\n" + shapes_ + "</svg>";
}

std::string sheetOf(const std::vector<std::string>& charts, size_t columns) {
  const size_t rows = (charts.size() + columns - 1) / columns;
  std::string text = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" +
                     at(kChartWidth * static_cast<double>(columns)) + "\" height=\"" +
                     at(kHeight * static_cast<double>(rows)) + "\">\n";
  for (size_t i = 0; i < charts.size(); ++i) {
    const size_t row = i / columns;
    const size_t column = i % columns;
    const std::string place = "<svg x=\"" + at(kChartWidth * static_cast<double>(column)) +
                              "\" y=\"" + at(kHeight * static_cast<double>(row)) +
                              "\" width=\"320\" height=\"230\"";
    text += place + charts[i].substr(4) + "\n";  // behind the chart's own "<svg"
  }
  return text + "</svg>\n";
}

}  // namespace tread::report
