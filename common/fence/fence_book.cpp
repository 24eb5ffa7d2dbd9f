// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/fence/fence_book.hpp"

#include <algorithm>
#include <iomanip>
#include <limits>
#include <sstream>

namespace tread {
namespace {

constexpr const char* kStayIn = "stay_in";
constexpr const char* kKeepOut = "keep_out";

bool readLine(const std::string& line, Fence& fence) {
  std::istringstream words(line);
  std::string kind;
  size_t corners = 0;
  words >> kind >> corners;
  if (corners > Fence::kMostCorners || (kind != kStayIn && kind != kKeepOut)) return false;
  fence.keep_out = kind == kKeepOut;
  fence.corners.resize(corners);
  for (Eigen::Vector2d& corner : fence.corners) words >> corner.x() >> corner.y();
  words.ignore();  // one space
  std::getline(words, fence.name);
  return words && faultOf(fence).empty();
}

}  // namespace

std::string toText(const std::vector<Fence>& fences) {
  std::ostringstream text;
  text << std::setprecision(std::numeric_limits<double>::max_digits10);
  for (const Fence& fence : fences) {
    text << (fence.keep_out ? kKeepOut : kStayIn) << ' ' << fence.corners.size();
    for (const Eigen::Vector2d& corner : fence.corners)
      text << ' ' << corner.x() << ' ' << corner.y();
    text << ' ' << fence.name << '\n';
  }
  return text.str();
}

std::vector<Fence> fencesFrom(const std::string& text, int& broken) {
  std::vector<Fence> fences;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    Fence fence;
    if (readLine(line, fence))
      fences.push_back(fence);
    else
      ++broken;
  }
  return fences;
}

const char* describe(FenceReceipt receipt) {
  switch (receipt) {
    case FenceReceipt::kAdded:
      return "added";
    case FenceReceipt::kKnown:
      return "in force already";
    case FenceReceipt::kRemoved:
      return "removed";
    case FenceReceipt::kNotThere:
      return "nothing of that name that an operator has added";
    case FenceReceipt::kForbidden:
      return "only the operator who holds the robot may remove a fence";
    case FenceReceipt::kInvalid:
      return "not a polygon of 3 to 64 corners with a name in ASCII";
    case FenceReceipt::kFull:
      return "too many fences or corners";
  }
  return "unknown";
}

Fence lostFences() {
  constexpr double kAll = Fence::kFarthest / 2.0;
  return {"lost_fences", true, {{-kAll, -kAll}, {kAll, -kAll}, {kAll, kAll}, {-kAll, kAll}}};
}

std::string FenceBook::bar() const {
  const std::string lost = lostFences().name;
  const bool known = std::none_of(fences_.begin(), fences_.end(),
                                  [&](const Fence& fence) { return fence.name == lost; });
  return known ? "" : "kept fences are lost: set them anew, then tread-fence " + lost + " --remove";
}

bool FenceBook::fit(const std::vector<Fence>& fences) {
  size_t corners = 0;
  for (const Fence& fence : fences) corners += fence.corners.size();
  return fences.size() <= kMost && corners <= kMostCorners;
}

FenceReceipt FenceBook::take(const FenceRequest& request, bool holds) {
  return request.removes ? remove(request.fence.name, holds) : add(request.fence, holds);
}

FenceReceipt FenceBook::add(const Fence& fence, bool holds) {
  if (!faultOf(fence).empty()) return FenceReceipt::kInvalid;
  std::vector<Fence> fences = fences_;
  const auto known = std::find(fences.begin(), fences.end(), fence);
  const bool is_known = known != fences.end();
  const bool lasts = is_known && static_cast<size_t>(known - fences.begin()) < lasting_;
  if (lasts || (is_known && !holds)) return FenceReceipt::kKnown;
  // A fence added by a stranger becomes the holder's.
  if (is_known) fences.erase(known);
  const auto place = static_cast<std::ptrdiff_t>(holds ? lasting_ : fences.size());
  fences.insert(fences.begin() + place, fence);
  const auto strangers = place + 1;
  while (!fit(fences) && strangers < static_cast<std::ptrdiff_t>(fences.size()))
    fences.erase(fences.begin() + strangers);
  // A full book may also have lost some.
  if (!fit(fences) && !(fence == lostFences())) return FenceReceipt::kFull;
  fences_ = std::move(fences);
  if (holds) ++lasting_;
  ++revision_;
  return is_known ? FenceReceipt::kKnown : FenceReceipt::kAdded;
}

FenceReceipt FenceBook::remove(const std::string& name, bool holds) {
  if (!holds) return FenceReceipt::kForbidden;
  const auto named = [&](const Fence& fence) { return fence.name == name; };
  const auto own = fences_.begin() + static_cast<std::ptrdiff_t>(own_);
  const auto lasting = fences_.begin() + static_cast<std::ptrdiff_t>(lasting_);
  lasting_ -= static_cast<size_t>(std::count_if(own, lasting, named));
  const auto gone = std::remove_if(own, fences_.end(), named);
  if (gone == fences_.end()) return FenceReceipt::kNotThere;
  fences_.erase(gone, fences_.end());
  ++revision_;
  return FenceReceipt::kRemoved;
}

}  // namespace tread
