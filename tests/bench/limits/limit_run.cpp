// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/bench/limits/limit_run.hpp"

#include <algorithm>
#include <cmath>

#include "common/messages/blank.hpp"
#include "common/messages/fence_messages.hpp"
#include "tools/robot/operator/calls.hpp"

namespace tread::limits {
namespace {

constexpr int64_t kTick = 5'000;           // [us]
constexpr int64_t kOperatorTick = 50'000;  // [us]
constexpr int64_t kGivesUp = 20'000'000;   // [us] of standing without a path
constexpr double kWellWithin = 0.3;        // [m]
constexpr double kOutsideSlack = 1e-3;     // [m]

/// A fence that the robot is inside of, or must return into.
struct Watched {
  Fence fence;
  bool within = false;
  double best = -1e9;  ///< [m] largest distance while it is outside
};

missions::RobotConfig configured(missions::RobotConfig config, const LimitWorld& world,
                                 const LimitOptions& options) {
  if (options.bridge_watches)
    config.motor_bridge.bridge.fences.own = world.fences;
  else
    config.motor_bridge.bridge.tilt.reset();
  config.planner.map.fences.clear();
  if (world.planner_knows && options.planner_keeps_off) config.planner.map.fences = world.fences;
  if (!options.planner_keeps_off) config.planner.map.full_speed = 0.0;
  return config;
}

/// The run of one mission.
class Run {
 public:
  Run(const missions::RobotConfig& robot, uint64_t seed, const LimitWorld& world,
      const LimitOptions& options)
      : world_(world),
        options_(options),
        outline_(robot.simulated.vehicle.outline),
        system_(configured(robot, world, options), world.mission.description,
                world.mission.T_map_start, seed, "", {}),
        person_(system_.bus().outside(), world.mission.T_map_goal),
        start_(system_.bus().now()) {
    for (const Fence& fence : world.fences) watched_.push_back({fence});
    Bus& outside = system_.bus().outside();
    outside.subscribe<plan_t>(kPlan, [this](const plan_t& message) { plan_ = message; });
    outside.subscribe<motor_t>(kMotor, [this](const motor_t& message) { hear(message); });
  }

  LimitRun drive() {
    int64_t stuck_since = start_;
    for (int64_t t = kTick; !result_.arrived; t += kTick) {
      system_.bus().runUntil(start_ + t);
      result_.seconds = static_cast<double>(t) * 1e-6;
      if (t % kOperatorTick == 0) person_.step(system_.bus().now());
      surprise();
      judge();
      result_.arrived = plan_.plan_status == plan_t::PLAN_ARRIVED;
      if (plan_.plan_status == plan_t::PLAN_DRIVING) stuck_since = start_ + t;
      if (start_ + t - stuck_since > kGivesUp || result_.seconds > options_.seconds) break;
    }
    result_.last_plan = operators::statusWord(plan_.plan_status) + ": " + plan_.reason;
    return result_;
  }

 private:
  void hear(const motor_t& message) {
    const auto is = [&](const char* word) {
      return message.state_reason.find(word) != std::string::npos;
    };
    const bool stopped = message.bridge_state == motor_t::STATE_DISARMED && was_armed_;
    if (stopped && is("fence ")) ++result_.fence_stops;
    if (stopped && (is("limit ") || is("roll and pitch"))) ++result_.tilt_stops;
    was_armed_ = message.bridge_state != motor_t::STATE_DISARMED;
  }

  /// A stranger's fence across the path of the driving robot.
  void surprise() {
    if (!world_.surprise_s || surprised_ || result_.seconds < *world_.surprise_s) return;
    const Pose2& here = system_.robot().truth().T_map_body;
    const double near = world_.surprise_ahead, half = world_.surprise_width / 2.0;
    FenceRequest request{"stranger", false, {"surprise", true, {}}};
    for (const Eigen::Vector2d& corner :
         {Eigen::Vector2d(near, -half), Eigen::Vector2d(near + 1.0, -half),
          Eigen::Vector2d(near + 1.0, half), Eigen::Vector2d(near, half)})
      request.fence.corners.push_back(here * corner);
    surprised_ = true;
    system_.bus().outside().publish(kFence, toMessage(request));
    watched_.push_back({request.fence});
  }

  void judge() {
    const sim::RobotTruth& truth = system_.robot().truth();
    result_.distance = truth.distance;
    result_.drove = result_.drove || truth.distance > 0.3;
    result_.tilt = std::max({result_.tilt, std::abs(truth.body.roll), std::abs(truth.body.pitch)});
    result_.inclination =
        std::max(result_.inclination, std::acos(std::min(1.0, truth.body.R_map_body(2, 2))));
    for (Watched& watched : watched_) {
      const double room = roomAt(watched.fence, truth.T_map_body, outline_);
      // While entering it swings: it counts as inside once it is well inside.
      const bool comes_in = world_.starts_outside && watched.fence.name == "yard";
      if (room >= (comes_in ? kWellWithin : 0.0)) watched.within = true;
      if (watched.within) {
        result_.least_room = std::min(result_.least_room, room);
      } else {
        watched.best = std::max(watched.best, room);
        result_.farther_out = std::max(result_.farther_out, watched.best - room - kOutsideSlack);
      }
    }
  }

  const LimitWorld& world_;
  LimitOptions options_;
  FootprintSize outline_;
  missions::RobotSystem system_;
  missions::Operator person_;
  int64_t start_;
  std::vector<Watched> watched_;
  plan_t plan_{};
  LimitRun result_;
  bool was_armed_ = false;
  bool surprised_ = false;
};

}  // namespace

LimitRun runLimits(const missions::RobotConfig& robot, uint64_t seed, const LimitWorld& world,
                   const LimitOptions& options) {
  return Run(robot, seed, world, options).drive();
}

}  // namespace tread::limits
