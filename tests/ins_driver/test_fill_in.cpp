// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>

#include "modules/ins_driver/core/fill_in.hpp"
#include "tests/helpers.hpp"

using namespace tread;
using namespace tread::ins;

namespace {

using tread::testing::kSecond;

constexpr int64_t kScans = 100'000;      // [us] between poses of scan matching
constexpr int64_t kDevice = 20'000;      // [us] between poses of the device
const Pose2 kScanFrame{3.0, -2.0, 0.7};  // in the map: the two frames have independent origins

/// A body on an arc of 10 m at 1 m/s, measured by a device and by scan matching.
class Watched {
 public:
  static Pose2 truth(int64_t utime) {
    return integrate({1.0, 0.0, 0.1}, 1e-6 * static_cast<double>(utime));
  }
  static InsEstimate measured(int64_t utime) {
    InsEstimate estimate;
    const Pose2 pose = truth(utime);
    estimate.utime = utime;
    estimate.p_map_body = {pose.x, pose.y, 231.0};
    estimate.R_map_body = Eigen::AngleAxisd(pose.yaw, Eigen::Vector3d::UnitZ());
    estimate.v_body = {1.0, 0.0, 0.0};
    estimate.position_std = {0.02, 0.02, 0.05};
    estimate.attitude_std = {0.005, 0.005, 0.01};
    return estimate;
  }
  /// Pose of scan matching, drifting sideways by 2 cm per metre.
  static ScanPose scanned(int64_t utime) {
    ScanPose pose;
    const double way = 1e-6 * static_cast<double>(utime);
    pose.utime = utime;
    pose.T_scan_body = inverse(kScanFrame) * truth(utime) * Pose2{0.0, 0.02 * way, 0.0};
    pose.v_body = {1.0, 0.0, 0.1};
    pose.std = {0.02 * way, 0.02 * way, 0.002 * way};
    return pose;
  }

  /// Advances the time; `device` returns an estimate or none.
  template <class Device>
  void run(double seconds, const Device& device) {
    for (const int64_t end = now_ + std::llround(seconds * 1e6); now_ < end;) {
      now_ += kDevice;
      if (now_ % kScans == 0) fill_in.observe(scanned(now_));
      if (std::optional<InsEstimate> estimate = device(now_))
        if (fill_in.complete(*estimate, now_)) track.push_back(*estimate);
      while (const auto filled = fill_in.next(now_)) track.push_back(*filled);
    }
  }
  void drive(double seconds) {
    run(seconds, [](int64_t utime) { return std::optional<InsEstimate>(measured(utime)); });
  }
  void silent(double seconds) {
    run(seconds, [](int64_t) { return std::optional<InsEstimate>(); });
  }
  double error() const {
    return distanceBetween(truth(track.back().utime),
                           {track.back().p_map_body.x(), track.back().p_map_body.y(), 0.0});
  }
  double yawError() const {
    return std::abs(
        wrapAngle(yawPitchRoll(track.back().R_map_body).yaw - truth(track.back().utime).yaw));
  }

  FillIn fill_in{FillInConfig{}};
  std::vector<InsEstimate> track;

 private:
  int64_t now_ = 0;
};

}  // namespace

TEST_CASE("a silent device is filled in for by scan matching, from its last pose on") {
  Watched body;
  body.drive(5.0);
  CHECK(body.fill_in.filled() == 0);
  const size_t before = body.track.size();
  body.silent(4.0);
  // The first after 150 ms, then one per scan.
  CHECK(body.track.size() >= before + 37);
  for (size_t i = before; i < body.track.size(); ++i) {
    CHECK(body.track[i].status == (InsStatus::kFilledIn | InsStatus::kNoAttitude));
    CHECK(body.track[i].utime > body.track[i - 1].utime);
  }
  CHECK(body.fill_in.since() == body.track[before].utime);
  // Scan matching has drifted by 8 cm; its unknown north adds no error.
  CHECK(body.error() == Approx(0.08).margin(0.02));
  CHECK(body.yawError() < 1e-6);
  CHECK(body.track.back().p_map_body.z() == Approx(231.0));
  CHECK(body.track.back().v_body.x() == Approx(1.0));
  CHECK(std::isnan(body.track.back().v_body.z()));
  // The device has .02 m and .01 rad, over 4 m of path; published drift: the root of .18² - .1².
  const double drift = std::sqrt(0.18 * 0.18 - 0.1 * 0.1);
  CHECK(body.track.back().position_std.x() ==
        Approx(std::sqrt(0.02 * 0.02 + drift * drift + 0.04 * 0.04)).epsilon(0.05));
  CHECK(body.track.back().attitude_std.z() == Approx(std::hypot(0.01, 0.1 * drift)).epsilon(0.05));
}

TEST_CASE("a device that comes back corrects, and where it is far off it jumps") {
  for (const double off : {0.0, 0.5}) {
    Watched body;
    body.drive(3.0);
    body.silent(3.0);
    body.run(1.0, [&](int64_t utime) {
      InsEstimate estimate = Watched::measured(utime);
      estimate.p_map_body.x() += off;
      return std::optional<InsEstimate>(estimate);
    });
    CHECK_FALSE(body.fill_in.since());
    int jumps = 0;
    for (const InsEstimate& estimate : body.track)
      jumps += (estimate.status & InsStatus::kJump) != 0 ? 1 : 0;
    CHECK(jumps == (off > 0.0 ? 1 : 0));
    CHECK(body.track.back().status == InsStatus::kGood);
  }
}

TEST_CASE("a device that knows no position, or no heading, keeps what it knows") {
  Watched body;
  body.drive(3.0);
  body.run(2.0, [](int64_t utime) {
    InsEstimate estimate = Watched::measured(utime);
    estimate.p_map_body.setConstant(kUnmeasured);
    estimate.status |= InsStatus::kNoPosition;
    return std::optional<InsEstimate>(estimate);
  });
  // At the device's rate: between two scans the pose is extrapolated with the twist.
  CHECK(body.track.size() == 250);
  CHECK(body.track.back().status == InsStatus::kFilledIn);
  CHECK(body.error() < 0.06);
  CHECK(body.track.back().attitude_std.z() == 0.01);

  // The antenna is 1 m ahead: without a heading its direction is unknown.
  body.run(2.0, [](int64_t utime) {
    InsEstimate estimate = Watched::measured(utime);
    const Eigen::Vector3d arm(1.0, 0.0, 2.0);
    estimate.p_map_body += estimate.R_map_body * arm;
    estimate.p_body_point = arm;
    estimate.position_std.head<2>().setConstant(std::hypot(0.02, 1.0));
    estimate.R_map_body.coeffs().setConstant(kUnmeasured);
    estimate.v_body.setConstant(kUnmeasured);
    estimate.status |= InsStatus::kNoHeading | InsStatus::kNoAttitude | InsStatus::kNoVelocity;
    return std::optional<InsEstimate>(estimate);
  });
  CHECK(body.track.back().status == (InsStatus::kFilledIn | InsStatus::kNoAttitude));
  CHECK(body.error() < 1e-3);
  CHECK(body.yawError() < 1e-3);
  CHECK(body.track.back().p_map_body.z() == Approx(231.0));
  CHECK(body.track.back().position_std.x() < 0.05);
  CHECK(body.track.back().v_body.x() == Approx(1.0));
}

TEST_CASE("nothing is filled in without a common start, beyond the drift, or over a new track") {
  Watched lost;
  lost.silent(3.0);
  CHECK(lost.track.empty());

  Watched far;
  far.drive(3.0);
  far.silent(10.0);
  CHECK(far.fill_in.since());
  far.silent(50.0);
  CHECK_FALSE(far.fill_in.since());
  // .5 m at the published 2 cm per metre.
  const double end = 1e-6 * static_cast<double>(far.track.back().utime);
  CHECK(std::sqrt(0.02 * end * 0.02 * end - 0.06 * 0.06) == Approx(0.5).margin(0.01));

  Watched anew;
  anew.drive(3.0);
  const size_t before = anew.track.size();
  ScanPose other = Watched::scanned(3 * kSecond + 1000);
  other.T_scan_body = {};
  other.new_track = true;
  anew.fill_in.observe(other);
  anew.silent(2.0);
  CHECK(anew.track.size() == before);
}

TEST_CASE("where scan matching falls silent, too, nothing is said to be filled in") {
  Watched body;
  body.drive(3.0);
  body.silent(1.0);
  CHECK(body.fill_in.since());
  // Nobody observes any more.
  CHECK_FALSE(body.fill_in.next(4 * kSecond + 900'000));
  CHECK(body.fill_in.since());
  CHECK_FALSE(body.fill_in.next(5 * kSecond + 100'000));
  CHECK_FALSE(body.fill_in.since());
}

TEST_CASE("what a device gives for a time that is filled in already is left out") {
  Watched body;
  body.drive(3.0);
  body.silent(1.0);
  const size_t before = body.track.size();
  InsEstimate late = Watched::measured(3 * kSecond + 300'000);
  CHECK_FALSE(body.fill_in.complete(late, 4 * kSecond + 10'000));
  CHECK(body.track.size() == before);
}
