// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <functional>
#include <limits>

#include <catch2/catch.hpp>

#include "common/messages/ins_messages.hpp"
#include "tests/helpers.hpp"

namespace tread {
namespace {

using tread::testing::kInf;
using tread::testing::kNan;

/// A valid message: at (3, 4, 5), rotated by yaw, pitch and roll, moving.
ins_t messageAt(double yaw, double pitch, double roll) {
  ins_t ins{};
  ins.position[0] = 3.0;
  ins.position[1] = 4.0;
  ins.position[2] = 5.0;
  const Eigen::Quaterniond q(isometryFrom({0, 0, 0}, {yaw, pitch, roll}).linear());
  ins.orientation[0] = q.w();
  ins.orientation[1] = q.x();
  ins.orientation[2] = q.y();
  ins.orientation[3] = q.z();
  ins.velocity[0] = 1.5;
  ins.velocity[1] = -0.1;
  ins.rate[2] = 0.3;
  return ins;
}

}  // namespace

TEST_CASE("a good INS message gives pose, twist and inclination") {
  const ins_t ins = messageAt(2.0, 0.1, -0.2);
  const auto planar_pose = planarPose(ins);
  REQUIRE(planar_pose);
  CHECK(planar_pose->x == 3.0);
  CHECK(planar_pose->y == 4.0);
  CHECK(planar_pose->yaw == Approx(2.0));
  const auto pose = spatialPose(ins);
  REQUIRE(pose);
  CHECK(pose->translation().isApprox(Eigen::Vector3d(3, 4, 5)));
  CHECK(pose->linear().isApprox(isometryFrom({0, 0, 0}, {2.0, 0.1, -0.2}).linear(), 1e-12));
  const auto twist = planarTwist(ins);
  REQUIRE(twist);
  CHECK(twist->v_x == 1.5);
  CHECK(twist->v_y == -0.1);
  CHECK(twist->omega == 0.3);
  const double slope = tilt(ins).inclination;
  CHECK(slope == Approx(std::acos(std::cos(0.1) * std::cos(0.2))));
}

TEST_CASE("heading does not change the inclination, and level ground has none") {
  for (const double yaw : {-3.0, 0.0, 1.0, 3.1}) {
    CHECK(tilt(messageAt(yaw, 0.0, 0.0)).inclination == Approx(0.0).margin(1e-7));
    CHECK(tilt(messageAt(yaw, 0.25, 0.0)).inclination == Approx(0.25));
  }
}

TEST_CASE("what the device does not know gives nothing, whether told by status or by NaN") {
  using Change = std::function<void(ins_t&)>;
  const std::vector<Change> no_pose{[](auto& m) { m.ins_status = ins_t::STATUS_NO_POSITION; },
                                    [](auto& m) { m.ins_status = ins_t::STATUS_NO_HEADING; },
                                    [](auto& m) { m.position[1] = kNan; },
                                    [](auto& m) { m.orientation[0] = kNan; },
                                    [](auto& m) { m.orientation[3] = kInf; },
                                    [](auto& m) { m.orientation[0] += 0.5; },
                                    [](auto& m) {
                                      for (double& part : m.orientation) part = 0.0;
                                    }};
  for (const auto& change : no_pose) {
    ins_t ins = messageAt(1.0, 0.0, 0.0);
    change(ins);
    CHECK_FALSE(planarPose(ins));
    CHECK_FALSE(spatialPose(ins));
  }
  const std::vector<Change> no_twist{[](auto& m) { m.ins_status = ins_t::STATUS_NO_VELOCITY; },
                                     [](auto& m) { m.velocity[0] = kNan; },
                                     [](auto& m) { m.rate[2] = -kInf; }};
  for (const auto& change : no_twist) {
    ins_t ins = messageAt(1.0, 0.0, 0.0);
    change(ins);
    CHECK_FALSE(planarTwist(ins));
    CHECK(planarPose(ins));
  }
  ins_t flat = messageAt(1.0, 0.2, 0.0);
  flat.ins_status = ins_t::STATUS_NO_ATTITUDE;
  CHECK(std::isnan(tilt(flat).inclination));
  CHECK(planarPose(flat));
}

TEST_CASE("a device that tells no height has a pose in the plane, but none in space") {
  for (const double height : {kNan, kInf}) {
    ins_t ins = messageAt(1.0, 0.0, 0.0);
    ins.position[2] = height;
    const auto pose = planarPose(ins);
    REQUIRE(pose);
    CHECK(pose->x == 3.0);
    CHECK(pose->yaw == Approx(1.0));
    CHECK_FALSE(spatialPose(ins));
  }
}

TEST_CASE("a gap or a jump does not hide the pose, what to do about it is the reader's choice") {
  ins_t ins = messageAt(1.0, 0.0, 0.0);
  ins.ins_status = ins_t::STATUS_GAP | ins_t::STATUS_JUMP;
  CHECK(planarPose(ins));
}

}  // namespace tread
