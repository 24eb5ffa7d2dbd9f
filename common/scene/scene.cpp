// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <nlohmann/json.hpp>

#include "common/config/config_reader.hpp"
#include "common/geometry/principal_axes.hpp"
#include "common/messages/ins_messages.hpp"
#include "common/report/text.hpp"
#include "common/vehicle/robot_description.hpp"

namespace tread {
namespace {

using Json = nlohmann::json;

constexpr int64_t kMapPeriodUs = 2'000'000;
constexpr double kMapReach = 15.0;    // [m] around the robot
constexpr double kFarthest = 1e6;     // [m] from the origin of map; beyond, a number is broken
constexpr double kRobotHeight = 0.4;  // [m] drawn

struct Rgba {
  double r, g, b, a;
};
// Okabe and Ito's colours, distinguishable also with red-green blindness.
constexpr Rgba kTreeColour{0.34, 0.71, 0.91, 0.5}, kPlanColour{0.90, 0.62, 0.00, 1.0},
    kDoubtColour{0.90, 0.62, 0.00, 0.3}, kGoalColour{0.00, 0.62, 0.45, 1.0},
    kRobotColour{0.00, 0.45, 0.70, 0.8};

Json timeOf(int64_t utime) {
  return {{"sec", utime / 1'000'000}, {"nsec", utime % 1'000'000 * 1000}};
}

Json vectorOf(double x, double y, double z) {
  return {{"x", x}, {"y", y}, {"z", z}};
}

Json turned(double yaw) {
  return {{"x", 0.0}, {"y", 0.0}, {"z", std::sin(yaw / 2.0)}, {"w", std::cos(yaw / 2.0)}};
}

Json poseOf(double x, double y, double z, double yaw) {
  return {{"position", vectorOf(x, y, z)}, {"orientation", turned(yaw)}};
}

Json colourOf(const Rgba& colour) {
  return {{"r", colour.r}, {"g", colour.g}, {"b", colour.b}, {"a", colour.a}};
}

Json entity(const std::string& id, const std::string& frame, int64_t utime) {
  Json made{{"id", id},
            {"frame_id", frame},
            {"timestamp", timeOf(utime)},
            {"lifetime", {{"sec", 0}, {"nsec", 0}}},
            {"frame_locked", true}};
  for (const char* kind : {"metadata", "arrows", "cubes", "spheres", "cylinders", "lines",
                           "triangles", "texts", "models"})
    made[kind] = Json::array();
  return made;
}

constexpr int kLineStrip = 0, kLineList = 2;  // foxglove.LineType

Json lineOf(int type, double thickness, const Rgba& colour, Json points) {
  return {{"type", type},
          {"pose", poseOf(0.0, 0.0, 0.0, 0.0)},
          {"thickness", thickness},
          {"scale_invariant", false},
          {"points", std::move(points)},
          {"color", colourOf(colour)},
          {"colors", Json::array()},
          {"indices", Json::array()}};
}

Json updateOf(Json one) {
  return {{"deletions", Json::array()}, {"entities", Json::array({std::move(one)})}};
}

/// The region of two standard deviations around a pattern's end, flat on the ground.
Json doubtOf(const double* pose, const std::vector<double>& covariance) {
  Eigen::Matrix2d position;
  position << covariance[0], covariance[1], covariance[1], covariance[3];
  if (!position.allFinite()) return nullptr;
  const PrincipalAxes axes = principalAxes(position);
  const Eigen::Vector2d lengths = 4.0 * axes.variances.cwiseMax(1e-6).cwiseSqrt();
  const double yaw = std::atan2(axes.directions(1, 1), axes.directions(0, 1));
  return {{"pose", poseOf(pose[0], pose[1], 0.01, yaw)},
          {"size", vectorOf(lengths[1], lengths[0], 0.02)},
          {"bottom_scale", 1.0},
          {"top_scale", 1.0},
          {"color", colourOf(kDoubtColour)}};
}

void appendPoint(std::string& bytes, float x, float y, float z) {
  const float point[3] = {x, y, z};
  if (!std::isfinite(x + y + z)) return;
  char raw[sizeof point];
  std::memcpy(raw, point, sizeof point);
  bytes.append(raw, sizeof raw);
}

SceneMessage sceneOf(Json drawn) {
  const uint64_t part = std::hash<std::string>()(drawn["id"].get<std::string>());
  return {"scene/plan", "foxglove.SceneUpdate", updateOf(std::move(drawn)).dump(), part};
}

std::string pointsOf(const scan_t& scan) {
  std::string bytes;
  for (size_t i = 0; i < scan.ranges.size(); ++i) {
    const double angle = scan.angle_first + static_cast<double>(i) * scan.angle_step;
    const auto range = static_cast<double>(scan.ranges[i]);
    if (range < scan.range_min || !(range <= scan.range_max)) continue;
    appendPoint(bytes, static_cast<float>(range * std::cos(angle)),
                static_cast<float>(range * std::sin(angle)), 0.0F);
  }
  for (const std::vector<float>& point : scan.points)
    if (point.size() == 3) appendPoint(bytes, point[0], point[1], point[2]);
  return bytes;
}

void appendCell(std::string& bytes, Cell cell) {
  unsigned char colour[4] = {0, 0, 0, 0};  // unknown: nothing is drawn
  if (cell == kObstacle) {
    colour[3] = 255;
  } else if (isFree(cell)) {
    colour[0] = colour[1] = colour[2] = static_cast<unsigned char>(230 - cell);
    colour[3] = 200;
  }
  bytes.append(reinterpret_cast<const char*>(colour), sizeof colour);
}

}  // namespace

std::vector<SceneMessage> SceneMaker::take(const LogEvent& event) {
  now_ = event.utime;
  made_.clear();
  dispatch(
      event, [this](const auto& message) { hear(message); }, kIns, kMap, kScan, kPlan, kPlanTree,
      kGoal, kConfig);
  for (const Event& told : teller_.take(event)) {
    const int level = told.severity == Severity::kInfo      ? 2
                      : told.severity == Severity::kWarning ? 3
                                                            : 4;
    const Json log{{"timestamp", timeOf(now_)}, {"level", level}, {"message", told.words},
                   {"name", told.source},       {"file", ""},     {"line", 0}};
    made_.push_back({"scene/events", "foxglove.Log",
                     log.dump(-1, ' ', false, Json::error_handler_t::replace), 0});
  }
  if (map_changed_ && placed_ && now_ - kMapPeriodUs >= map_drawn_) drawMap();
  return std::move(made_);
}

void SceneMaker::hear(const ins_t& ins) {
  const auto pose = planarPose(ins);
  if (!pose || pose->position().norm() > kFarthest) return;
  T_map_body_ = *pose;
  placed_ = true;
  const double z = std::isfinite(ins.position[2]) ? ins.position[2] : 0.0;
  const Json transform{{"timestamp", timeOf(now_)},
                       {"parent_frame_id", "map"},
                       {"child_frame_id", "body"},
                       {"translation", vectorOf(pose->x, pose->y, z)},
                       {"rotation",
                        {{"w", ins.orientation[0]},
                         {"x", ins.orientation[1]},
                         {"y", ins.orientation[2]},
                         {"z", ins.orientation[3]}}}};
  made_.push_back({"scene/tf", "foxglove.FrameTransform", transform.dump(), 0});
}

void SceneMaker::hear(const map_tile_t& message) {
  if (!isPossibleTile(message)) return;
  if (!map_) map_ = std::make_unique<TileMap>(message.cell_size, message.tile_cells);
  if (message.tile_cells != map_->tileCells() || message.cell_size != map_->cellSize()) return;
  Tile tile{message.tile_x, message.tile_y, message.utime, message.cells};
  map_changed_ = map_->put(std::move(tile)) || map_changed_;
}

void SceneMaker::drawMap() {
  const double size = map_->cellSize();
  const int half = static_cast<int>(kMapReach / size);
  const CellIndex lower{static_cast<int>(std::floor(T_map_body_.x / size)) - half,
                        static_cast<int>(std::floor(T_map_body_.y / size)) - half};
  const Grid window = map_->window(lower, 2 * half, 2 * half);
  std::string bytes;
  bytes.reserve(4 * window.cells().size());
  for (const Cell cell : window.cells()) appendCell(bytes, cell);
  Json fields = Json::array();
  constexpr int kUint8 = 1;  // foxglove.NumericType
  for (const char* name : {"red", "green", "blue", "alpha"})
    fields.push_back({{"name", name}, {"offset", fields.size()}, {"type", kUint8}});
  const Json grid{{"timestamp", timeOf(now_)},
                  {"frame_id", "map"},
                  {"pose", poseOf(lower.x * size, lower.y * size, 0.0, 0.0)},
                  {"column_count", window.width()},
                  {"cell_size", {{"x", size}, {"y", size}}},
                  {"row_stride", 4 * window.width()},
                  {"cell_stride", 4},
                  {"fields", fields},
                  {"data", base64(bytes)}};
  made_.push_back({"scene/map", "foxglove.Grid", grid.dump(), 0});
  map_changed_ = false;
  map_drawn_ = now_;
}

void SceneMaker::hear(const scan_t& scan) {
  Json fields = Json::array();
  constexpr int kFloat32 = 7;  // foxglove.NumericType
  for (const char* name : {"x", "y", "z"})
    fields.push_back({{"name", name}, {"offset", 4 * fields.size()}, {"type", kFloat32}});
  const double* const at = scan.sensor_position;
  const double* const turn = scan.sensor_orientation;
  const Json cloud{
      {"timestamp", timeOf(now_)},
      {"frame_id", "body"},
      {"pose",
       {{"position", vectorOf(at[0], at[1], at[2])},
        {"orientation", {{"w", turn[0]}, {"x", turn[1]}, {"y", turn[2]}, {"z", turn[3]}}}}},
      {"point_stride", 12},
      {"fields", fields},
      {"data", base64(pointsOf(scan))}};
  made_.push_back({"scene/scan", "foxglove.PointCloud", cloud.dump(), 0});
}

void SceneMaker::hear(const plan_t& plan) {
  Json drawn = entity("plan", "map", now_);
  Json points = Json::array();
  if (placed_) points.push_back(vectorOf(T_map_body_.x, T_map_body_.y, 0.03));
  for (size_t i = 0; i < plan.pose.size(); ++i) {
    const std::vector<double>& pose = plan.pose[i];
    if (pose.size() != 3 || plan.covariance[i].size() != 6) continue;
    points.push_back(vectorOf(pose[0], pose[1], 0.03));
    Json doubt = doubtOf(pose.data(), plan.covariance[i]);
    if (!doubt.is_null()) drawn["cylinders"].push_back(std::move(doubt));
  }
  if (points.size() > 1) drawn["lines"].push_back(lineOf(kLineStrip, 0.08, kPlanColour, points));
  made_.push_back(sceneOf(std::move(drawn)));
}

void SceneMaker::hear(const plan_tree_t& tree) {
  Json drawn = entity("tree", "map", now_);
  Json points = Json::array();
  const auto node = [&](size_t i) {
    return vectorOf(static_cast<double>(tree.node_pose[i][0]),
                    static_cast<double>(tree.node_pose[i][1]), 0.02);
  };
  for (size_t i = 0; i < tree.parent.size(); ++i) {
    if (tree.parent[i] < 0 || static_cast<size_t>(tree.parent[i]) >= i) continue;
    points.push_back(node(static_cast<size_t>(tree.parent[i])));
    points.push_back(node(i));
  }
  if (!points.empty()) drawn["lines"].push_back(lineOf(kLineList, 0.02, kTreeColour, points));
  made_.push_back(sceneOf(std::move(drawn)));
}

void SceneMaker::hear(const goal_t& goal) {
  Json drawn = entity("goal", "map", now_);
  if (goal.goal_id != 0 && std::isfinite(goal.goal_pose[0] + goal.goal_pose[1])) {
    const double radius = std::isfinite(goal.position_tolerance) ? goal.position_tolerance : 0.5;
    drawn["cylinders"].push_back({{"pose", poseOf(goal.goal_pose[0], goal.goal_pose[1], 0.0, 0.0)},
                                  {"size", vectorOf(2.0 * radius, 2.0 * radius, 0.05)},
                                  {"bottom_scale", 1.0},
                                  {"top_scale", 1.0},
                                  {"color", colourOf(kGoalColour)}});
  }
  made_.push_back(sceneOf(std::move(drawn)));
}

void SceneMaker::hear(const config_t& config) {
  if (config.config_process != "mapping") return;
  Json drawn = entity("robot", "body", now_);
  try {
    ConfigReader reader = ConfigReader::fromText(config.config_text, "CONFIG of mapping");
    const FootprintSize body = readRobot(reader).outline;
    const double length = body.front + body.rear;
    drawn["cubes"].push_back(
        {{"pose", poseOf((body.front - body.rear) / 2.0, 0.0, kRobotHeight / 2.0, 0.0)},
         {"size", vectorOf(length, 2.0 * body.half_width, kRobotHeight)},
         {"color", colourOf(kRobotColour)}});
    drawn["arrows"].push_back({{"pose", poseOf(0.0, 0.0, kRobotHeight, 0.0)},
                               {"shaft_length", 0.7 * body.front},
                               {"shaft_diameter", 0.08},
                               {"head_length", 0.3 * body.front},
                               {"head_diameter", 0.16},
                               {"color", colourOf(kPlanColour)}});
  } catch (const std::exception&) {
    return;  // a log older than robot descriptions
  }
  made_.push_back(sceneOf(std::move(drawn)));
}

}  // namespace tread
