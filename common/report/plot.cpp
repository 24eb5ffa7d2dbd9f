// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/report/plot.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <cairo.h>

#include "common/report/text.hpp"
#include "common/store/output_file.hpp"

namespace tread::report {

struct Picture::Surface {
  cairo_surface_t* surface;
  cairo_t* context;

  Surface(int width, int height)
      : surface(cairo_image_surface_create(CAIRO_FORMAT_ARGB32, width, height)),
        context(cairo_create(surface)) {}
  ~Surface() {
    cairo_destroy(context);
    cairo_surface_destroy(surface);
  }
};

namespace {

void setColour(cairo_t* context, const Colour& colour) {
  cairo_set_source_rgba(context, colour.red, colour.green, colour.blue, colour.alpha);
}

void setFont(cairo_t* context, double size, bool bold) {
  cairo_select_font_face(context, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                         bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(context, size);
}

double textWidth(cairo_t* context, const std::string& words) {
  cairo_text_extents_t extents;
  cairo_text_extents(context, words.c_str(), &extents);
  return extents.x_advance;
}

bool isFinite(const Eigen::Vector2d& point) {
  return std::isfinite(point.x()) && std::isfinite(point.y());
}

}  // namespace

Colour seriesColour(size_t i) {
  constexpr Colour kSeries[] = {kBlue, kRed, kGreen, kOrange, kPink, kSkyBlue};
  return kSeries[i % 6];
}

Picture::Picture(int width, int height, const std::string& title)
    : surface_(std::make_unique<Surface>(width, height)) {
  setColour(surface_->context, {1.0, 1.0, 1.0});
  cairo_paint(surface_->context);
  text(20, 28, title, 17.0, kBlack, true);
}

Picture::~Picture() = default;

void Picture::save(const std::string& path) {
  OutputFile file(path);
  const cairo_status_t status = cairo_surface_write_to_png_stream(
      surface_->surface,
      [](void* to, const unsigned char* bytes, unsigned int size) {
        try {
          static_cast<OutputFile*>(to)->write(bytes, size);
          return CAIRO_STATUS_SUCCESS;
        } catch (const WriteError&) {
          return CAIRO_STATUS_WRITE_ERROR;  // commit() throws it again
        }
      },
      &file);
  if (status != CAIRO_STATUS_SUCCESS && status != CAIRO_STATUS_WRITE_ERROR)
    throw std::runtime_error(path +
                             ": cannot write the picture: " + cairo_status_to_string(status));
  file.commit();
}

void Picture::text(double x, double y, const std::string& line, double size, Colour colour,
                   bool bold) {
  setColour(surface_->context, colour);
  setFont(surface_->context, size, bold);
  cairo_move_to(surface_->context, x, y);
  cairo_show_text(surface_->context, line.c_str());
}

void Picture::fill(Box box, Colour colour) {
  setColour(surface_->context, colour);
  cairo_rectangle(surface_->context, box.x, box.y, box.width, box.height);
  cairo_fill(surface_->context);
}

Panel::Panel(Picture& picture, Box box, Axes axes)
    : picture_(picture), box_(box), axes_(std::move(axes)) {
  if (!(axes_.x_max > axes_.x_min)) axes_.x_max = axes_.x_min + 1.0;
  if (!(axes_.y_max > axes_.y_min)) axes_.y_max = axes_.y_min + 1.0;
  if (axes_.equal) {
    const double scale = std::min(box_.width / (axes_.x_max - axes_.x_min),
                                  box_.height / (axes_.y_max - axes_.y_min));
    const double x_more = (box_.width / scale - (axes_.x_max - axes_.x_min)) / 2.0;
    const double y_more = (box_.height / scale - (axes_.y_max - axes_.y_min)) / 2.0;
    axes_.x_min -= x_more;
    axes_.x_max += x_more;
    axes_.y_min -= y_more;
    axes_.y_max += y_more;
  }
  cairo_t* context = picture_.surface_->context;
  cairo_save(context);
  cairo_rectangle(context, box_.x, box_.y, box_.width, box_.height);
  cairo_clip(context);
}

Eigen::Vector2d Panel::toPixels(const Eigen::Vector2d& point) const {
  return {box_.x + (point.x() - axes_.x_min) / (axes_.x_max - axes_.x_min) * box_.width,
          box_.y + (axes_.y_max - point.y()) / (axes_.y_max - axes_.y_min) * box_.height};
}

void Panel::line(const std::vector<Eigen::Vector2d>& points, const Style& style) {
  cairo_t* context = picture_.surface_->context;
  setColour(context, style.colour);
  cairo_set_line_width(context, style.width);
  cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
  const double dash[] = {6.0, 4.0};
  cairo_set_dash(context, dash, style.dashed ? 2 : 0, 0.0);
  bool pen_down = false;
  for (const Eigen::Vector2d& point : points) {
    const Eigen::Vector2d pixel = toPixels(point);
    if (!isFinite(pixel)) {
      pen_down = false;  // a gap in the series
    } else if (pen_down) {
      cairo_line_to(context, pixel.x(), pixel.y());
    } else {
      cairo_move_to(context, pixel.x(), pixel.y());
      pen_down = true;
    }
  }
  cairo_stroke(context);
  cairo_set_dash(context, dash, 0, 0.0);
  legendEntry(style);
}

void Panel::polygon(const std::vector<Eigen::Vector2d>& corners, Colour fill) {
  cairo_t* context = picture_.surface_->context;
  setColour(context, fill);
  for (const Eigen::Vector2d& corner : corners) {
    const Eigen::Vector2d pixel = toPixels(corner);
    cairo_line_to(context, pixel.x(), pixel.y());
  }
  cairo_close_path(context);
  cairo_fill(context);
}

void Panel::disc(const Eigen::Vector2d& centre, double radius, Colour fill) {
  const double pixels = radius / (axes_.x_max - axes_.x_min) * box_.width;
  dot(centre, fill, pixels);
}

void Panel::dot(const Eigen::Vector2d& at, Colour colour, double pixels) {
  const Eigen::Vector2d pixel = toPixels(at);
  if (!isFinite(pixel)) return;
  cairo_t* context = picture_.surface_->context;
  setColour(context, colour);
  cairo_arc(context, pixel.x(), pixel.y(), pixels, 0.0, 2.0 * kPi);
  cairo_fill(context);
}

void Panel::text(const Eigen::Vector2d& at, const std::string& words, Colour colour, double size) {
  const Eigen::Vector2d pixel = toPixels(at);
  setFont(picture_.surface_->context, size, false);
  const double room = box_.x + box_.width - textWidth(picture_.surface_->context, words);
  picture_.text(std::max(box_.x, std::min(pixel.x(), room)), pixel.y(), words, size, colour);
}

void Panel::bar(double x, double height, double width, Colour fill) {
  polygon({{x - width / 2, 0.0},
           {x + width / 2, 0.0},
           {x + width / 2, height},
           {x - width / 2, height}},
          fill);
}

void Panel::verticalLine(double x, const Style& style) {
  line({{x, axes_.y_min}, {x, axes_.y_max}}, style);
}

void Panel::grid(const Grid& cells, double opacity) {
  cairo_t* context = picture_.surface_->context;
  // Without anti-aliasing there are no seams between cells.
  cairo_set_antialias(context, CAIRO_ANTIALIAS_NONE);
  const double half = cells.cellSize() / 2.0;
  for (int y = 0; y < cells.height(); ++y) {
    for (int x = 0; x < cells.width(); ++x) {
      const CellIndex index{cells.lower().x + x, cells.lower().y + y};
      const Cell cell = cells.at(index);
      if (isFree(cell)) continue;
      const double grey = cell == kUnknown ? 0.8 : 0.15;
      const Eigen::Vector2d c = cells.centre(index);
      polygon({{c.x() - half, c.y() - half},
               {c.x() + half, c.y() - half},
               {c.x() + half, c.y() + half},
               {c.x() - half, c.y() + half}},
              {grey, grey, grey, opacity});
    }
  }
  cairo_set_antialias(context, CAIRO_ANTIALIAS_DEFAULT);
}

void Panel::legendEntry(const Style& style) {
  if (!style.label.empty()) legend_.push_back(style);
}

void Panel::finish() {
  cairo_t* context = picture_.surface_->context;
  cairo_restore(context);
  setColour(context, kGrey);
  cairo_set_line_width(context, 1.0);
  cairo_rectangle(context, box_.x, box_.y, box_.width, box_.height);
  cairo_stroke(context);
  xTicks();
  yTicks();
  picture_.text(box_.x, box_.y - 8, axes_.title, 13.0, kBlack, true);
  legend();
}

void Panel::xTicks() {
  cairo_t* context = picture_.surface_->context;
  setFont(context, 11.0, false);
  const double bottom = box_.y + box_.height;
  for (size_t i = 0; i < x_names_.size(); ++i) {
    const Eigen::Vector2d pixel = toPixels({static_cast<double>(i), axes_.y_min});
    const double width = textWidth(context, x_names_[i]);
    picture_.text(pixel.x() - width / 2, bottom + 15, x_names_[i], 11.0);
  }
  const double step = tickStep(axes_.x_max - axes_.x_min, 7);
  for (const double x : ticks(axes_.x_min, axes_.x_max, step)) {
    if (!x_names_.empty()) break;
    const Eigen::Vector2d pixel = toPixels({x, axes_.y_min});
    const std::string words = tickText(x, step);
    picture_.text(pixel.x() - textWidth(context, words) / 2, bottom + 15, words, 11.0);
    setFont(context, 11.0, false);
  }
  const double width = textWidth(context, axes_.x_label);
  picture_.text(box_.x + (box_.width - width) / 2, bottom + 32, axes_.x_label, 11.0);
}

void Panel::yTicks() {
  cairo_t* context = picture_.surface_->context;
  setFont(context, 11.0, false);
  const double step = tickStep(axes_.y_max - axes_.y_min, 5);
  for (const double y : ticks(axes_.y_min, axes_.y_max, step)) {
    const Eigen::Vector2d pixel = toPixels({axes_.x_min, y});
    const std::string words = tickText(y, step);
    picture_.text(box_.x - textWidth(context, words) - 5, pixel.y() + 4, words, 11.0);
    setFont(context, 11.0, false);
  }
  if (axes_.y_label.empty()) return;
  const double width = textWidth(context, axes_.y_label);
  cairo_save(context);
  cairo_translate(context, box_.x - 40, box_.y + (box_.height + width) / 2);
  cairo_rotate(context, -kPi / 2);
  setColour(context, kBlack);
  cairo_move_to(context, 0, 0);
  cairo_show_text(context, axes_.y_label.c_str());
  cairo_restore(context);
}

void Panel::legend() {
  if (legend_.empty()) return;
  cairo_t* context = picture_.surface_->context;
  setFont(context, 11.0, false);
  double widest = 0.0;
  for (const Style& entry : legend_) widest = std::max(widest, textWidth(context, entry.label));
  const double height = 16.0 * static_cast<double>(legend_.size()) + 8.0;
  const double left = box_.x + box_.width - widest - 46.0;
  setColour(context, {1.0, 1.0, 1.0, 0.85});
  cairo_rectangle(context, left, box_.y + 6, widest + 40, height);
  cairo_fill(context);
  double y = box_.y + 21;
  for (const Style& entry : legend_) {
    setColour(context, entry.colour);
    cairo_set_line_width(context, std::max(2.0, entry.width));
    const double dash[] = {6.0, 4.0};
    cairo_set_dash(context, dash, entry.dashed ? 2 : 0, 0.0);
    cairo_move_to(context, left + 6, y - 4);
    cairo_line_to(context, left + 28, y - 4);
    cairo_stroke(context);
    cairo_set_dash(context, dash, 0, 0.0);
    picture_.text(left + 34, y, entry.label, 11.0);
    y += 16;
  }
}

}  // namespace tread::report
