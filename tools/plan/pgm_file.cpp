// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/plan/pgm_file.hpp"

#include <algorithm>

#include "tools/plan/words.hpp"

namespace tread::plan {
namespace {

size_t pixelCount(const GreyImage& image) {
  return static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
}

GreyImage readHeader(Words& words) {
  GreyImage image;
  image.width = static_cast<int>(words.integer("the width", 1, kLongestSide));
  image.height = static_cast<int>(words.integer("the height", 1, kLongestSide));
  if (static_cast<int64_t>(image.width) * image.height > kMostCells)
    throw words.error("more than " + std::to_string(kMostCells) + " pixels");
  image.white = static_cast<int>(words.integer("the greatest grey value", 1, 65'535));
  if (image.white > 255) throw words.error("two bytes a pixel; convert the picture to 8 bits");
  return image;
}

[[noreturn]] void throwTruncated(const Words& words, size_t there, size_t needed) {
  throw words.error("the file holds " + std::to_string(there) + " of " + std::to_string(needed) +
                    " pixels; it is truncated");
}

/// P5: one blank behind the header, then a byte a pixel.
void readBytes(Words& words, GreyImage& image) {
  const size_t count = pixelCount(image);
  const std::string_view rest = words.rest();
  const size_t there = rest.empty() ? 0 : rest.size() - 1;
  if (there < count) throwTruncated(words, there, count);
  image.pixels.resize(count);
  std::transform(rest.begin() + 1, rest.begin() + 1 + static_cast<std::ptrdiff_t>(count),
                 image.pixels.begin(), [](char c) { return static_cast<uint8_t>(c); });
}

void readNumbers(Words& words, GreyImage& image) {
  const size_t count = pixelCount(image);
  // A pixel is a digit and a blank at least: nothing is reserved for what cannot be there.
  if (words.left() + 1 < 2 * count) throwTruncated(words, words.left() / 2, count);
  image.pixels.reserve(count);
  while (image.pixels.size() < count)
    image.pixels.push_back(static_cast<uint8_t>(words.integer("a pixel", 0, image.white)));
}

}  // namespace

GreyImage parsePgm(std::string bytes, const std::string& name) {
  Words words(std::move(bytes), name, '#');
  const std::string kind(words.peek().substr(0, 8));
  if (kind != "P2" && kind != "P5")
    throw words.error("is no PGM picture, which begins with P5 or P2; convert it to PGM");
  words.expect(kind);
  GreyImage image = readHeader(words);
  if (kind == "P5") {
    readBytes(words, image);
  } else {
    readNumbers(words, image);
  }
  const auto brightest = std::max_element(image.pixels.begin(), image.pixels.end());
  if (*brightest > image.white)
    throw words.error("a pixel is " + std::to_string(*brightest) + ", more than the header's " +
                      std::to_string(image.white));
  return image;
}

GreyImage readPgm(const std::string& path) {
  return parsePgm(readWhole(path), path);
}

}  // namespace tread::plan
