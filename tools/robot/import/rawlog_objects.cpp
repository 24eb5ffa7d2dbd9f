// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/import/rawlog_objects.hpp"

#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationVelodyneScan.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <limits>

#include "common/messages/blank.hpp"

namespace tread::import {
namespace {

using namespace mrpt::obs;

using Take = std::function<void(const RawlogRecord&)>;

/// A sweep has fewer returns.
constexpr size_t kMostReturns = 1'000'000;
/// Returns per message: a tenth of a revolution of the larger devices.
constexpr size_t kSlice = 10'000;

void setSensorPose(const mrpt::poses::CPose3D& pose, scan_t& scan) {
  mrpt::math::CQuaternionDouble turn;
  pose.getAsQuaternion(turn);
  for (int i = 0; i < 3; ++i) scan.sensor_position[i] = pose[static_cast<unsigned>(i)];
  for (int i = 0; i < 4; ++i) scan.sensor_orientation[i] = turn[i];
}

class RawlogReading {
 public:
  explicit RawlogReading(const Take& take) : take_(take) {}

  void object(const mrpt::serialization::CSerializable& object) {
    if (const auto* frame = dynamic_cast<const CSensoryFrame*>(&object)) {
      for (const auto& observation : *frame)
        if (observation) this->observation(*observation);
    } else if (const auto* actions = dynamic_cast<const CActionCollection*>(&object)) {
      for (size_t i = 0; i < actions->size(); ++i) action(actions->get(i));
    } else if (const auto* observation = dynamic_cast<const CObservation*>(&object)) {
      this->observation(*observation);
    } else {
      leaveOut(object, "holds neither poses nor scans");
    }
  }

 private:
  void leaveOut(const mrpt::rtti::CObject& object, const std::string& why, bool lost = false) {
    take_(LeftOut{std::string(object.GetRuntimeClass()->className) + ": " + why, lost});
  }
  void lose(const mrpt::rtti::CObject& object, const std::string& why) {
    leaveOut(object, why, true);
  }

  void action(const CAction& action) {
    const auto* step = dynamic_cast<const CActionRobotMovement2D*>(&action);
    if (step == nullptr) return leaveOut(action, "no motion in the plane");
    const mrpt::poses::CPose2D made = step->estimationMethod == CActionRobotMovement2D::emOdometry
                                          ? step->rawOdometryIncrementReading
                                          : step->poseChange->getMeanVal();
    odometry_ = odometry_ * Pose2{made.x(), made.y(), made.phi()};
    pose(action, step->timestamp, odometry_);
  }

  void pose(const mrpt::rtti::CObject& object, mrpt::system::TTimeStamp time, const Pose2& pose) {
    if (time == INVALID_TIMESTAMP) return lose(object, "without a time");
    take_(PoseSample{mrpt::Clock::toDouble(time), pose});
  }

  void observation(const CObservation& observation) {
    if (observation.timestamp == INVALID_TIMESTAMP) return lose(observation, "without a time");
    if (const auto* odometry = dynamic_cast<const CObservationOdometry*>(&observation)) {
      const mrpt::poses::CPose2D& at = odometry->odometry;
      pose(observation, observation.timestamp, {at.x(), at.y(), at.phi()});
    } else if (const auto* sweep = dynamic_cast<const CObservation2DRangeScan*>(&observation)) {
      this->sweep(*sweep);
    } else if (const auto* packets = dynamic_cast<const CObservationVelodyneScan*>(&observation)) {
      points(*packets);
    } else {
      leaveOut(observation, "holds neither poses nor scans");
    }
  }

  void sweep(const CObservation2DRangeScan& sweep) {
    const size_t beams = sweep.getScanSize();
    if (beams < 2 || beams > kMostReturns) return lose(sweep, "a wrong number of beams");
    if (sweep.deltaPitch != 0.0) return leaveOut(sweep, "tilts while it sweeps");
    auto scan = blank<scan_t>();
    setSensorPose(sweep.sensorPose, scan);
    const double direction = sweep.rightToLeft ? 1.0 : -1.0;
    scan.angle_first = -direction * sweep.aperture / 2.0;
    scan.angle_step = direction * sweep.aperture / static_cast<double>(beams - 1);
    scan.range_min = 0.0;
    scan.range_max = sweep.maxRange;
    scan.num_beams = static_cast<int32_t>(beams);
    for (size_t i = 0; i < beams; ++i) {
      // An invalid range means "no hit" only if it is the maximum range.
      const float range = sweep.getScanRange(i);
      const bool counts = sweep.getScanRangeValidity(i);
      scan.ranges.push_back(counts                    ? range
                            : range >= sweep.maxRange ? std::numeric_limits<float>::infinity()
                                                      : std::numeric_limits<float>::quiet_NaN());
    }
    take_(RawlogScan{mrpt::Clock::toDouble(sweep.timestamp), scan});
  }

  void points(const CObservationVelodyneScan& packets) {
    if (packets.scan_packets.empty() || packets.calibration.empty())
      return lose(packets, "without packets or calibration");
    // Computing the points modifies the observation, so it works on a copy.
    CObservationVelodyneScan working = packets;
    CObservationVelodyneScan::TGeneratePointCloudParameters parameters;
    parameters.generatePerPointTimestamp = true;
    working.generatePointCloud(parameters);
    const auto& cloud = working.point_cloud;
    if (cloud.size() == 0 || cloud.size() > kMostReturns || cloud.timestamp.size() != cloud.size())
      return lose(packets, "a wrong number of returns");
    for (size_t first = 0; first < cloud.size(); first += kSlice)
      slice(working, first, std::min(first + kSlice, cloud.size()));
  }

  void slice(const CObservationVelodyneScan& packets, size_t first, size_t end) {
    const auto& cloud = packets.point_cloud;
    auto scan = blank<scan_t>();
    setSensorPose(packets.sensorPose, scan);
    scan.num_points = static_cast<int32_t>(end - first);
    for (size_t i = first; i < end; ++i)
      scan.points.push_back({cloud.x[i], cloud.y[i], cloud.z[i]});
    const double begin = mrpt::Clock::toDouble(cloud.timestamp[first]);
    const double duration = mrpt::Clock::toDouble(cloud.timestamp[end - 1]) - begin;
    scan.duration = static_cast<int32_t>(std::clamp(duration, 0.0, 1.0) * 1e6);
    take_(RawlogScan{begin, scan});
  }

  const Take& take_;
  Pose2 odometry_;  // sum of the steps
};

}  // namespace

void readRawlogObjects(const std::string& path, const Take& take) {
  size_t objects = 0;
  try {
    mrpt::io::CFileGZInputStream file(path);
    auto archive = mrpt::serialization::archiveFrom(file);
    RawlogReading reading(take);
    while (!file.checkEOF()) {
      const auto object = archive.ReadObject();
      if (object) reading.object(*object);
      ++objects;
    }
  } catch (const mrpt::serialization::CExceptionEOF&) {
    // MRPT detects the end of the file only by reading past it.
  } catch (const std::exception& e) {
    // MRPT's own message is a source position and a stack trace.
    take(RawlogProblem{"object " + std::to_string(objects + 1) + " cannot be read"});
  }
}

}  // namespace tread::import
