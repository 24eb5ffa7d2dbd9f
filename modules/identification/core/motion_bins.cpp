// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/motion_bins.hpp"

#include "modules/identification/core/pruning.hpp"

namespace tread::gap {
namespace {

/// Speeds of both tracks over ground in the bins of a segment.
std::vector<Both> speedsIn(const std::vector<MotionSample>& motion, double begin, size_t bins,
                           double gauge) {
  std::vector<Both> speeds;
  for (size_t i = 0; i < bins; ++i) {
    const double from = begin + kBin * static_cast<double>(i);
    const Twist2 twist = twistTo(between(poseAt(motion, from), poseAt(motion, from + kBin)), kBin);
    speeds.push_back({twist.v_x, 0.5 * gauge * twist.omega});
  }
  return speeds;
}

/// The bins of one segment except the first and the last; `motions`: with all effects, then without
/// each.
void addBins(const std::vector<const std::vector<MotionSample>*>& motions,
             const VehicleModel& vehicle, const Segment& segment, MotionBin bin,
             const Observations& data, std::vector<MotionBin>& bins) {
  const auto count = static_cast<size_t>((segment.end - segment.begin()) / kBin);
  std::vector<std::vector<Both>> speeds;
  for (const auto* motion : motions)
    speeds.push_back(speedsIn(*motion, segment.begin(), count, vehicle.gauge));
  for (size_t i = 1; i + 1 < count; ++i) {
    bin.begin = segment.begin() + kBin * static_cast<double>(i);
    bin.block = data.blockAt(bin.drive, bin.segment, bin.begin);
    bin.speed = speeds[0][i];
    const Both driven{bin.speed[0] / vehicle.forward_gain, bin.speed[1] / vehicle.yaw_gain};
    bin.tracks = {driven[0] - driven[1], driven[0] + driven[1]};
    bin.lost.assign(speeds.size() - 1, Both{});
    for (size_t kind = 0; kind < 2; ++kind) {
      bin.before[kind] = speeds[0][i - 1][kind] - bin.speed[kind];
      bin.after[kind] = speeds[0][i + 1][kind] - bin.speed[kind];
      for (size_t e = 0; e < bin.lost.size(); ++e)
        bin.lost[e][kind] = speeds[1 + e][i][kind] - bin.speed[kind];
    }
    bins.push_back(bin);
  }
}

}  // namespace

std::vector<MotionBin> binsOf(const Fitter& fitter, const FitState& state,
                              const std::vector<std::string>& effects) {
  const Observations& data = fitter.data();
  std::vector<std::vector<std::vector<MotionSample>>> motions{data.simulate(state.model.vehicle)};
  for (const std::string& effect : effects)
    motions.push_back(data.simulate(switchedOff(fitter, state, {effect}).model.vehicle));
  std::vector<MotionBin> bins;
  for (size_t d = 0; d < data.drives().size(); ++d)
    for (size_t s = 0; s < data.drives()[d].segments.size(); ++s) {
      std::vector<const std::vector<MotionSample>*> of;
      for (const auto& motion : motions) of.push_back(&motion[data.segmentIndex(d, s)]);
      MotionBin bin;
      bin.drive = d;
      bin.segment = s;
      addBins(of, state.model.vehicle, data.drives()[d].segments[s], bin, data, bins);
    }
  return bins;
}

}  // namespace tread::gap
