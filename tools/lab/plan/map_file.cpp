// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/plan/map_file.hpp"

#include "tools/lab/plan/plan_files.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "common/config/config_reader.hpp"
#include "common/config/scalars.hpp"
#include "common/grid/clearance.hpp"
#include "tools/lab/plan/tokenizer.hpp"

namespace tread::plan {
namespace {

enum class Mode { kTrinary, kScale, kRaw };

/// How a nav2 map's file interprets its pixels.
struct PixelRule {
  Mode mode = Mode::kTrinary;
  bool negate = false;
  double occupied = 0.65;
  double free = 0.25;
};

Cell ofOccupancy(double percent) {
  return percent >= 100.0 ? kObstacle : static_cast<Cell>(percent);
}

/// The cell for a pixel's brightness 0..1, as in nav2's map server.
Cell cellOf(double shade, const PixelRule& rule) {
  if (rule.mode == Mode::kRaw) {
    const double value = std::round(shade * 255.0);
    return value <= 100.0 ? ofOccupancy(value) : kUnknown;
  }
  const double occupied = rule.negate ? shade : 1.0 - shade;
  if (occupied > rule.occupied) return kObstacle;
  if (occupied < rule.free) return kFree;
  if (rule.mode == Mode::kTrinary) return kUnknown;
  return ofOccupancy(std::rint((occupied - rule.free) / (rule.occupied - rule.free) * 100.0));
}

PixelRule readRule(ConfigReader& reader) {
  PixelRule rule;
  std::string mode = "trinary";
  reader.choice("mode", mode, {"trinary", "scale", "raw"});
  if (mode != "trinary") rule.mode = mode == "scale" ? Mode::kScale : Mode::kRaw;
  std::string negate;
  reader.choice("negate", negate, {"0", "1", "false", "true", "False", "True"}, true);
  rule.negate = negate == "1" || negate == "true" || negate == "True";
  reader.number("occupied_thresh", rule.occupied, {0.0, 1.0}, "1", true);
  reader.number("free_thresh", rule.free, {0.0, 1.0}, "1", true);
  if (rule.free >= rule.occupied)
    throw reader.error("free_thresh", "must be below occupied_thresh");
  return rule;
}

Grid gridOf(const GreyImage& image, double resolution, const PixelRule& rule) {
  Grid grid(resolution, {0, 0}, image.width, image.height);
  std::vector<Cell> cells;
  for (int value = 0; value <= image.white; ++value)
    cells.push_back(cellOf(static_cast<double>(value) / image.white, rule));
  const auto width = static_cast<size_t>(image.width);
  for (size_t row = 0; row < static_cast<size_t>(image.height); ++row) {
    const size_t from = (static_cast<size_t>(image.height) - 1 - row) * width;  // top row first
    for (size_t x = 0; x < width; ++x)
      grid.cells()[row * width + x] = cells[image.pixels[from + x]];
  }
  return grid;
}

/// The grey value that map_saver writes for unknown cells; nav2's usual free_thresh of 0.25 makes
/// them free.
constexpr uint8_t kUnknownGrey = 205;

std::string unknownAsFree(const GreyImage& image, const PixelRule& rule) {
  const auto count = std::count(image.pixels.begin(), image.pixels.end(), kUnknownGrey);
  if (count == 0 || image.white != 255 || !isFree(cellOf(kUnknownGrey / 255.0, rule))) return {};
  return std::to_string(count) +
         " cells of grey 205, which map_saver writes for unknown cells, are " +
         "free by free_thresh " + formatNumber(rule.free) +
         ", as nav2 reads it; with mode: trinary and free_thresh: 0.196 they are unknown";
}

/// Unknown keys belong to other programs and are ignored.
MapFile readNav2(const std::string& path) {
  ConfigReader reader = ConfigReader::fromFile(path);
  MapFile map;
  reader.path("image", map.image, true);
  double resolution = 0.05;
  reader.number("resolution", resolution, {1e-3, 100.0}, "m", true);
  std::vector<double> origin;
  reader.numbers("origin", origin, 3, {-1e6, 1e6}, "m, m, rad", true);
  const PixelRule rule = readRule(reader);
  map.name = path;
  map.T_map_grid = {origin[0], origin[1], origin[2]};
  const GreyImage image = readPgm(map.image);
  map.note = unknownAsFree(image, rule);
  map.grid = gridOf(image, resolution, rule);
  return map;
}

Grid gridFrom(const MapFile& map, int least_obstacle) {
  Grid grid = map.grid;
  std::transform(map.costs.begin(), map.costs.end(), grid.cells().begin(),
                 [&](uint8_t cost) { return cost >= least_obstacle ? kObstacle : kFree; });
  return grid;
}

size_t pixelCount(const GreyImage& image) {
  return static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
}

GreyImage readHeader(Tokenizer& tokens) {
  GreyImage image;
  image.width = static_cast<int>(tokens.integer("the width", 1, kLongestSide));
  image.height = static_cast<int>(tokens.integer("the height", 1, kLongestSide));
  if (static_cast<int64_t>(image.width) * image.height > kMostCells)
    throw tokens.error("more than " + std::to_string(kMostCells) + " pixels");
  image.white = static_cast<int>(tokens.integer("the largest grey value", 1, 65'535));
  if (image.white > 255) throw tokens.error("two bytes a pixel; convert the picture to 8 bits");
  return image;
}

[[noreturn]] void throwTruncated(const Tokenizer& tokens, size_t there, size_t needed) {
  throw tokens.error("the file holds " + std::to_string(there) + " of " + std::to_string(needed) +
                     " pixels; it is truncated");
}

/// Why a P5 picture has more bytes than pixels, from the bytes after its header.
std::string surplusReason(std::string_view rest) {
  if (rest.substr(0, 2).find('#') != std::string_view::npos)
    return "there is a comment after the largest grey value, where PGM allows none";
  if (rest.substr(0, 2) == "\r\n")
    return "there is CR LF after the largest grey value, where PGM allows one byte";
  return "PGM allows nothing after the pixels";
}

/// P5: one blank after the header, then one byte per pixel and nothing else, since an additional
/// byte would shift the picture.
void readBytes(Tokenizer& tokens, GreyImage& image) {
  const size_t count = pixelCount(image);
  const std::string_view rest = tokens.rest();
  const size_t there = rest.empty() ? 0 : rest.size() - 1;
  if (there < count) throwTruncated(tokens, there, count);
  if (there > count || rest.front() == '#')
    throw tokens.error("the file holds " + std::to_string(there) + " bytes for " +
                       std::to_string(count) + " pixels; " + surplusReason(rest));
  image.pixels.resize(count);
  std::transform(rest.begin() + 1, rest.end(), image.pixels.begin(),
                 [](char c) { return static_cast<uint8_t>(c); });
}

void readNumbers(Tokenizer& tokens, GreyImage& image) {
  const size_t count = pixelCount(image);
  // A pixel has at least a digit and a blank: do not reserve memory for pixels that cannot exist.
  if (tokens.left() + 1 < 2 * count) throwTruncated(tokens, tokens.left() / 2, count);
  image.pixels.reserve(count);
  while (image.pixels.size() < count)
    image.pixels.push_back(static_cast<uint8_t>(tokens.integer("a pixel", 0, image.white)));
  if (!tokens.atEnd())
    throw tokens.error("there is more text after the last of " + std::to_string(count) + " pixels");
}

/// The header before the cells.
struct Header {
  int width = 0;
  int height = 0;
  double cell_size = 0.0;
};

/// Readers for the values of the header's keys.
using Readers = std::map<std::string, std::function<void()>>;

Readers readersOf(Tokenizer& tokens, Header& header, MapFile& map) {
  const auto threshold = [&tokens](int& value, int64_t min) {
    value = static_cast<int>(tokens.integer("the threshold", min, 256));
  };
  return {
      {"discretization(cells):",
       [&] {
         header.width = static_cast<int>(tokens.integer("the width", 1, kLongestSide));
         header.height = static_cast<int>(tokens.integer("the height", 1, kLongestSide));
       }},
      {"obsthresh:", [&, threshold] { threshold(map.thresholds.obstacle, 1); }},
      {"cost_inscribed_thresh:", [&, threshold] { threshold(map.thresholds.inscribed, 1); }},
      {"cost_possibly_circumscribed_thresh:",
       [&, threshold] { threshold(map.thresholds.possibly_circumscribed, -1); }},
      {"cellsize(meters):",
       [&] {
         header.cell_size = tokens.number("the cell size", {1e-3, 100.0}, "m");
       }},
      {"nominalvel(mpersecs):",
       [&] {
         map.nominal_speed = tokens.number("the speed", {1e-3, 100.0}, "m/s");
       }},
      {"timetoturn45degsinplace(secs):",
       [&] {
         map.turn_time = tokens.number("the time to turn", {1e-3, 1e4}, "s");
       }},
      {"start(meters,rads):", [&] { map.T_map_start = tokens.pose("the start", 1e6, 100.0); }},
      {"end(meters,rads):", [&] { map.T_map_goal = tokens.pose("the end", 1e6, 100.0); }},
  };
}

std::string keysWithout(const Readers& readers, const std::set<std::string>& seen) {
  std::vector<std::string> keys;
  for (const auto& [key, read] : readers)
    if (seen.count(key) == 0) keys.push_back(key);
  return joinWords(keys);
}

/// Reads up to and including the word "environment:".
Header readHeader(Tokenizer& tokens, MapFile& map) {
  Header header;
  const Readers readers = readersOf(tokens, header, map);
  std::set<std::string> seen;
  for (;;) {
    const std::string key(tokens.next("environment:").substr(0, 60));
    if (key == "environment:") break;
    const auto reader = readers.find(key);
    if (reader == readers.end())
      throw tokens.error(formatText(key) + " is not a key of an SBPL environment (x, y, theta); " +
                         "missing so far: " + keysWithout(readers, seen));
    if (!seen.insert(key).second) throw tokens.error(key + " is given twice");
    reader->second();
  }
  if (seen.size() < readers.size())
    throw tokens.error("missing before environment: " + keysWithout(readers, seen));
  return header;
}

std::vector<uint8_t> readCosts(Tokenizer& tokens, const Header& header) {
  const auto count = static_cast<int64_t>(header.width) * header.height;
  const std::string size = std::to_string(header.width) + " x " + std::to_string(header.height);
  if (count > kMostCells)
    throw tokens.error(size + " are more than " + std::to_string(kMostCells) + " cells");
  // A cost has at least a digit and a blank: do not reserve memory for costs that cannot exist.
  if (static_cast<int64_t>(tokens.left()) + 1 < 2 * count)
    throw tokens.error("the file is too short for the costs of " + size +
                       " cells; it is truncated");
  std::vector<uint8_t> costs;
  costs.reserve(static_cast<size_t>(count));
  while (static_cast<int64_t>(costs.size()) < count)
    costs.push_back(static_cast<uint8_t>(tokens.integer("a cost", 0, 255)));
  if (!tokens.atEnd()) throw tokens.error("more costs than those of " + size + " cells follow");
  return costs;
}

}  // namespace

MapFile readMap(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  if (extension == ".cfg") return parseSbplEnvironment(readWhole(path), path);
  if (extension == ".yaml" || extension == ".yml") return readNav2(path);
  throw ConfigError(path + ": a map is the .yaml of a nav2 map or the .cfg of an SBPL environment");
}

Grid gridForFootprint(const MapFile& map) {
  return map.costs.empty() ? map.grid : gridFrom(map, map.thresholds.obstacle);
}

Grid gridForPoint(const MapFile& map) {
  if (map.costs.empty()) return map.grid;
  return gridFrom(map, std::min(map.thresholds.obstacle, map.thresholds.inscribed));
}

Grid grownBy(const Grid& grid, double radius) {
  const ClearanceField clearance(grid, true);
  // The clearance is exact at a cell's centre; its corners may have that much less.
  const double needed = radius + grid.cellSize() * std::sqrt(0.5);
  Grid grown = grid;
  for (int y = grid.lower().y; y < grid.lower().y + grid.height(); ++y)
    for (int x = grid.lower().x; x < grid.lower().x + grid.width(); ++x) {
      const Eigen::Vector2d centre = grid.centre({x, y});
      if (isFree(grid.at({x, y})) && clearance.quick(centre.x(), centre.y()) < needed)
        grown.set({x, y}, kObstacle);
    }
  return grown;
}

GreyImage parsePgm(std::string bytes, const std::string& name) {
  Tokenizer tokens(std::move(bytes), name, '#');
  const std::string kind(tokens.peek().substr(0, 8));
  if (kind != "P2" && kind != "P5")
    throw tokens.error("is not a PGM picture (which begins with P5 or P2); convert it to PGM");
  tokens.expect(kind);
  GreyImage image = readHeader(tokens);
  if (kind == "P5") {
    readBytes(tokens, image);
  } else {
    readNumbers(tokens, image);
  }
  const auto brightest = std::max_element(image.pixels.begin(), image.pixels.end());
  if (*brightest > image.white)
    throw tokens.error("a pixel is " + std::to_string(*brightest) + ", more than the header's " +
                       std::to_string(image.white));
  return image;
}

GreyImage readPgm(const std::string& path) {
  return parsePgm(readWhole(path), path);
}

MapFile parseSbplEnvironment(std::string text, const std::string& name) {
  Tokenizer tokens(std::move(text), name);
  MapFile map;
  map.name = name;
  const Header header = readHeader(tokens, map);
  map.costs = readCosts(tokens, header);
  map.grid = Grid(header.cell_size, {0, 0}, header.width, header.height);
  map.grid = gridForFootprint(map);
  return map;
}

}  // namespace tread::plan
