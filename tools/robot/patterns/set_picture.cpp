// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/patterns/set_picture.hpp"

#include "tools/robot/patterns/set_text.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/geometry/principal_axes.hpp"
#include "common/report/plot.hpp"

namespace tread::patterns {
namespace {

using report::Box;
using report::Colour;
using report::Panel;

// 95 % quantile of the squared Mahalanobis distance in the plane.
constexpr double kChi2Of95 = 5.991;
constexpr double kPanelWidth = 470.0, kPanelHeight = 400.0;  // [pixels]
// [pixels] of the single panel for all classes
constexpr double kWideWidth = 860.0, kWideHeight = 680.0;
constexpr size_t kMostPanels = 4;
constexpr double kSpaceX = 80.0, kSpaceY = 95.0;  // [pixels] around a panel
constexpr double kTick = 18.0;                    // [pixels] length of the mark of the end heading
constexpr double kLetter = 5.8;                   // [pixels] width of a letter of a label, about
constexpr double kLabelHeight = 12.0;             // [pixels]
constexpr double kLabelSize = 10.0;               // [points]

using Points = std::vector<Eigen::Vector2d>;

/// Bounding box of points, in metres.
struct Bounds {
  Eigen::Vector2d low{0.0, 0.0};
  Eigen::Vector2d high{0.0, 0.0};

  void add(const Eigen::Vector2d& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
};

/// The 95 % ellipse of the end position; empty if the covariance is unknown.
Points endEllipse(const MotionPattern& pattern) {
  const PoseCovariance& c = pattern.end_covariance;
  if (std::isnan(c[0])) return {};
  Eigen::Matrix2d covariance;
  covariance << c[0], c[1], c[1], c[3];
  const PrincipalAxes principal = principalAxes(covariance);
  const Eigen::Vector2d axes = (kChi2Of95 * principal.variances.cwiseMax(0.0)).cwiseSqrt();
  Points ellipse;
  for (int i = 0; i <= 48; ++i) {
    const double angle = 2.0 * kPi * i / 48.0;
    const Eigen::Vector2d round(axes.x() * std::cos(angle), axes.y() * std::sin(angle));
    ellipse.push_back(pattern.end().position() + principal.directions * round);
  }
  return ellipse;
}

Points pathOf(const MotionPattern& pattern) {
  Points path{{0.0, 0.0}};
  for (const Pose2& pose : pattern.trajectory) path.push_back(pose.position());
  return path;
}

/// Places labels so that they cover neither each other nor a path. In pixels from the start, y
/// downwards; a place is the left end of a line of text.
class LabelPlaces {
 public:
  /// Keeps labels off a point of a path.
  void block(const Eigen::Vector2d& point) { blocked_.push_back(point); }

  /// The free place nearest to the wanted one, found by searching up and down.
  Eigen::Vector2d take(const Eigen::Vector2d& wanted, double width) {
    Eigen::Vector2d place = wanted;
    for (int i = 1; i < 80 && covered(place, width); ++i)
      place.y() = wanted.y() + (i % 2 == 0 ? -1.0 : 1.0) * ((i + 1) / 2) * kLabelHeight / 3.0;
    taken_.push_back({place, width});
    return place;
  }

 private:
  bool covered(const Eigen::Vector2d& place, double width) const {
    const bool by_label = std::any_of(taken_.begin(), taken_.end(), [&](const auto& other) {
      return std::abs(other.first.y() - place.y()) < kLabelHeight &&
             place.x() < other.first.x() + other.second && other.first.x() < place.x() + width;
    });
    return by_label || std::any_of(blocked_.begin(), blocked_.end(), [&](const auto& point) {
             return point.x() > place.x() - 2.0 && point.x() < place.x() + width + 2.0 &&
                    point.y() > place.y() - kLabelHeight && point.y() < place.y() + 3.0;
           });
  }

  std::vector<Eigen::Vector2d> blocked_;
  std::vector<std::pair<Eigen::Vector2d, double>> taken_;
};

/// Panel with the trajectories of one entry class, or of all.
class ClassPanel {
 public:
  /// An empty class means all. The box is in pixels.
  ClassPanel(const std::vector<PicturedSet>& sets, std::string entry_class, Box box)
      : sets_(sets), entry_class_(std::move(entry_class)), box_(box) {
    for (const PicturedSet& each : sets_)
      for (const MotionPattern* pattern : shownOf(each.set)) include(*pattern);
    // A turn on the spot needs space for its heading mark.
    const Eigen::Vector2d middle = (bounds_.low + bounds_.high) / 2.0;
    const Eigen::Vector2d half =
        ((bounds_.high - bounds_.low) / 2.0).cwiseMax(Eigen::Vector2d(0.1, 0.1));
    const double scale =
        std::max(half.x() / (box_.width / 2.0 - 75.0), half.y() / (box_.height / 2.0 - 35.0));
    metres_per_pixel_ = scale;
    // Space for the names to the right of the ends.
    middle_ = middle + Eigen::Vector2d(35.0 * scale, 0.0);
  }

  void draw(report::Picture& picture) {
    const Eigen::Vector2d half(box_.width / 2.0 * metres_per_pixel_,
                               box_.height / 2.0 * metres_per_pixel_);
    const std::string title =
        entry_class_.empty() ? "all entry classes together" : "beginning in " + entry_class_;
    Panel panel(picture, box_,
                {title, "forward [m]", "left [m]", middle_.x() - half.x(), middle_.x() + half.x(),
                 middle_.y() - half.y(), middle_.y() + half.y(), false});
    panel.line({{-1e3, 0.0}, {1e3, 0.0}}, {report::kLightGrey, 1.0, false, ""});
    panel.line({{0.0, -1e3}, {0.0, 1e3}}, {report::kLightGrey, 1.0, false, ""});
    for (size_t s = 0; s < sets_.size(); ++s) drawSet(panel, s);
    drawLabels(panel);
    panel.dot({0.0, 0.0}, report::kBlack, 3.5);
    if (sets_.size() > 1)
      for (size_t s = 0; s < sets_.size(); ++s)
        panel.legendEntry({setColour(s), 2.0, s > 0, sets_[s].label});
    panel.finish();
  }

 private:
  std::vector<const MotionPattern*> shownOf(const PatternSet& set) const {
    if (!entry_class_.empty()) return set.startingIn(entry_class_);
    std::vector<const MotionPattern*> all;
    for (const MotionPattern& pattern : set.patterns()) all.push_back(&pattern);
    return all;
  }

  void include(const MotionPattern& pattern) {
    for (const Eigen::Vector2d& point : pathOf(pattern)) bounds_.add(point);
    for (const Eigen::Vector2d& point : endEllipse(pattern)) bounds_.add(point);
  }

  static Colour setColour(size_t s) { return s == 0 ? report::kBlue : report::kRed; }

  /// For one set a colour per pattern, for two a colour per set.
  Colour colourOf(size_t s, size_t pattern) const {
    return sets_.size() > 1 ? setColour(s) : report::seriesColour(pattern);
  }

  Eigen::Vector2d tipOf(const MotionPattern& pattern) const {
    const double length = kTick * metres_per_pixel_;
    const Pose2& end = pattern.end();
    return end.position() + length * Eigen::Vector2d(std::cos(end.yaw), std::sin(end.yaw));
  }

  void drawSet(Panel& panel, size_t s) const {
    const auto patterns = shownOf(sets_[s].set);
    for (size_t p = 0; p < patterns.size(); ++p) {
      Colour colour = colourOf(s, p);
      const Points ellipse = endEllipse(*patterns[p]);
      colour.alpha = 0.18;
      if (!ellipse.empty()) panel.polygon(ellipse, colour);
      colour.alpha = 0.6;
      panel.line(ellipse, {colour, 0.8, false, ""});
      colour.alpha = 1.0;
      panel.line(pathOf(*patterns[p]), {colour, 1.8, s > 0, ""});
      panel.line({patterns[p]->end().position(), tipOf(*patterns[p])}, {colour, 1.0, false, ""});
      panel.dot(patterns[p]->end().position(), colour, 2.6);
    }
  }

  /// Names at the ends; a pattern in both sets is labelled in the first.
  void drawLabels(Panel& panel) const {
    LabelPlaces places;
    for (const PicturedSet& each : sets_)
      for (const MotionPattern* pattern : shownOf(each.set)) blockPath(*pattern, places);
    for (size_t s = 0; s < sets_.size(); ++s) {
      const auto patterns = shownOf(sets_[s].set);
      for (size_t p = 0; p < patterns.size(); ++p) {
        if (s > 0 && sets_[0].set.findByName(patterns[p]->name) != nullptr) continue;
        const Colour colour = sets_.size() > 1 ? report::kBlack : colourOf(s, p);
        drawLabel(panel, *patterns[p], colour, places);
      }
    }
  }

  Eigen::Vector2d toPixels(const Eigen::Vector2d& p_start) const {
    return Eigen::Vector2d(p_start.x(), -p_start.y()) / metres_per_pixel_;
  }

  Eigen::Vector2d toMetres(const Eigen::Vector2d& pixels) const {
    return Eigen::Vector2d(pixels.x(), -pixels.y()) * metres_per_pixel_;
  }

  void blockPath(const MotionPattern& pattern, LabelPlaces& places) const {
    Points path = pathOf(pattern);
    path.push_back(tipOf(pattern));
    for (size_t i = 1; i < path.size(); ++i)
      for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0})
        places.block(toPixels(path[i - 1] + share * (path[i] - path[i - 1])));
  }

  void drawLabel(Panel& panel, const MotionPattern& pattern, Colour colour,
                 LabelPlaces& places) const {
    const Eigen::Vector2d tip = toPixels(tipOf(pattern));
    const double width = kLetter * static_cast<double>(pattern.name.size());
    const bool leftwards =
        tip.x() < toPixels(pattern.end().position()).x() - 0.3 * kTick || pattern.end().x < -0.05;
    const Eigen::Vector2d wanted(leftwards ? tip.x() - width - 4.0 : tip.x() + 4.0, tip.y() + 4.0);
    const Eigen::Vector2d place = places.take(wanted, width);
    if (std::abs(place.y() - wanted.y()) > kLabelHeight) {
      const Eigen::Vector2d anchor(leftwards ? place.x() + width + 2.0 : place.x() - 2.0,
                                   place.y() - 4.0);
      panel.line({tipOf(pattern), toMetres(anchor)}, {report::kGrey, 0.6, false, ""});
    }
    panel.text(toMetres(place), pattern.name, colour, kLabelSize);
  }

  const std::vector<PicturedSet>& sets_;
  std::string entry_class_;
  Box box_;
  Bounds bounds_;
  Eigen::Vector2d middle_{0.0, 0.0};
  double metres_per_pixel_ = 1.0;
};

/// Entry classes in the order of the sets; one empty name (all together) if there are too many for
/// a panel each.
std::vector<std::string> panelClasses(const std::vector<PicturedSet>& sets) {
  std::vector<std::string> names;
  for (const PicturedSet& each : sets)
    for (const MotionPattern& pattern : each.set.patterns())
      if (std::find(names.begin(), names.end(), pattern.entry_class) == names.end())
        names.push_back(pattern.entry_class);
  return names.size() > kMostPanels ? std::vector<std::string>{""} : names;
}

}  // namespace

void drawSets(const std::vector<PicturedSet>& sets, const std::string& path) {
  const std::vector<std::string> classes = panelClasses(sets);
  const bool together = classes.front().empty();
  const double width = together ? kWideWidth : kPanelWidth;
  const double height = together ? kWideHeight : kPanelHeight;
  const size_t columns = std::min<size_t>(classes.size(), classes.size() == 4 ? 2 : 3);
  const size_t rows = (classes.size() + columns - 1) / columns;
  std::string title = sets.front().label;
  if (sets.size() > 1) title += " and " + sets.back().label;
  const double total_height = static_cast<double>(rows) * (height + kSpaceY);
  report::Picture picture(static_cast<int>(static_cast<double>(columns) * (width + kSpaceX) + 20.0),
                          static_cast<int>(total_height + 50.0), title);
  for (size_t i = 0; i < classes.size(); ++i) {
    const double x = 65.0 + static_cast<double>(i % columns) * (width + kSpaceX);
    const double y = 75.0 + static_cast<double>(i / columns) * (height + kSpaceY);
    ClassPanel(sets, classes[i], {x, y, width, height}).draw(picture);
  }
  picture.text(65.0, total_height + 35.0,
               "Start at the dot, heading to the right. At each end: heading, and the ellipse that "
               "holds 95 % of the ends.",
               11.0, report::kGrey);
  picture.save(path);
}

}  // namespace tread::patterns
