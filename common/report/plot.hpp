// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/grid/grid.hpp"

namespace tread::report {

struct Colour {
  double red = 0.0;  ///< 0..1, as the others
  double green = 0.0;
  double blue = 0.0;
  double alpha = 1.0;
};

/// Colours distinguishable also with red-green blindness (Okabe and Ito).
inline constexpr Colour kBlack{0.10, 0.10, 0.10};
inline constexpr Colour kGrey{0.55, 0.55, 0.55};
inline constexpr Colour kLightGrey{0.88, 0.88, 0.88};
inline constexpr Colour kOrange{0.90, 0.62, 0.00};
inline constexpr Colour kSkyBlue{0.34, 0.71, 0.91};
inline constexpr Colour kGreen{0.00, 0.62, 0.45};
inline constexpr Colour kBlue{0.00, 0.45, 0.70};
inline constexpr Colour kRed{0.84, 0.37, 0.00};
inline constexpr Colour kPink{0.80, 0.47, 0.65};

/// The i-th colour of a series; repeats after six.
Colour seriesColour(size_t i);

/// A rectangle of the picture [pixels], y downwards.
struct Box {
  double x = 0.0;
  double y = 0.0;
  double width = 0.0;
  double height = 0.0;
};

struct Style {
  Colour colour = kBlack;
  double width = 1.5;  ///< [pixels]
  bool dashed = false;
  std::string label;  ///< for the legend; empty = none
};

class Panel;

/// A PNG picture made of panels and text.
class Picture {
 public:
  Picture(int width, int height, const std::string& title);
  ~Picture();
  Picture(const Picture&) = delete;
  Picture& operator=(const Picture&) = delete;

  /// Writes the PNG, as OutputFile does; throws WriteError with one line if that fails.
  void save(const std::string& path);
  /// Text with its left end at (x, y) [pixels].
  void text(double x, double y, const std::string& line, double size = 13.0, Colour colour = kBlack,
            bool bold = false);
  void fill(Box box, Colour colour);

 private:
  friend class Panel;
  struct Surface;
  std::unique_ptr<Surface> surface_;
};

/// Data coordinates inside a box of a picture: axes with ticks, lines, areas, points, a legend.
class Panel {
 public:
  struct Axes {
    std::string title;
    std::string x_label;
    std::string y_label;
    double x_min = 0.0, x_max = 1.0, y_min = 0.0, y_max = 1.0;
    bool equal = false;  ///< same scale on both axes (maps): the range is widened to fit the box
  };
  Panel(Picture& picture, Box box, Axes axes);
  Panel(const Panel&) = delete;
  Panel& operator=(const Panel&) = delete;

  void line(const std::vector<Eigen::Vector2d>& points, const Style& style);
  void polygon(const std::vector<Eigen::Vector2d>& corners, Colour fill);
  void disc(const Eigen::Vector2d& centre, double radius, Colour fill);
  /// A dot of constant size [pixels].
  void dot(const Eigen::Vector2d& at, Colour colour, double pixels = 3.0);
  /// Starts at a point, shifted left if it would leave the panel.
  void text(const Eigen::Vector2d& at, const std::string& words, Colour colour = kBlack,
            double size = 11.0);
  /// Vertical bar from 0 to `height`.
  void bar(double x, double height, double width, Colour fill);
  void verticalLine(double x, const Style& style);
  /// An occupancy grid: obstacles dark, unknown grey, free left as it is.
  void grid(const Grid& cells, double opacity = 1.0);
  /// Adds an entry without drawing anything.
  void legendEntry(const Style& style);
  /// Names instead of numbers below the x axis; call before finish().
  void xNames(std::vector<std::string> names) { x_names_ = std::move(names); }
  /// Draws frame, ticks and legend on top. Call once, last.
  void finish();

 private:
  Eigen::Vector2d toPixels(const Eigen::Vector2d& point) const;
  void xTicks();
  void yTicks();
  void legend();

  Picture& picture_;
  Box box_;
  Axes axes_;
  std::vector<Style> legend_;
  std::vector<std::string> x_names_;
};

}  // namespace tread::report
