// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/witness.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "modules/identification/core/log_validation.hpp"
#include "modules/identification/core/search.hpp"

namespace tread::gap {
namespace {

constexpr double kUnlike = 0.2;     // of the effect, in directions that are no scale of the motion
constexpr double kShown = 0.7;      // of the effect, not in the motion to the side
constexpr double kSharp = 0.25;     // standard error of a share that says anything
constexpr int kRounds = 30;         // until scales and share agree
constexpr size_t kLeastRows = 100;  // with wheel speeds

/// What the wheels say of one row, and what the model says with and without the effect.
struct WheelRow {
  size_t kind = 0;  ///< 0 = speed, 1 = yaw rate
  int block = 0;
  double wheels = 0.0;   ///< [m/s] or [rad/s] of the tracks, without slip
  double without = 0.0;  ///< predicted without the effect
  double effect = 0.0;   ///< what it changes
  double weight = 0.0;   ///< 1 / scale^2
};

/// The track speeds of a drive while it moves as a row was measured.
class WheelSpeeds {
 public:
  WheelSpeeds(const Drive& drive, double gauge)
      : speed_(encoderSums(drive, [](const TrackCommand& c) { return 0.5 * (c.left + c.right); })),
        turn_(encoderSums(drive,
                          [gauge](const TrackCommand& c) { return (c.right - c.left) / gauge; })) {}

  std::optional<double> speed(const Observation& row, double late) const {
    return speed_[row.segment].mean(row.begin - late, row.end - late);
  }
  std::optional<double> turn(const Observation& row, double late) const {
    return turn_[row.segment].mean(row.begin - late, row.end - late);
  }

 private:
  RunningSums speed_;
  RunningSums turn_;
};

std::vector<WheelRow> wheelRows(const Fitter& fitter, const FitState& state,
                                const Eigen::VectorXd& without) {
  const Observations& data = fitter.data();
  const MeasurementModel& ins = state.model.measurement;
  std::vector<WheelSpeeds> wheels;
  for (const Drive& drive : data.drives()) wheels.emplace_back(drive, state.model.vehicle.gauge);
  std::vector<WheelRow> rows;
  for (size_t i = 0; i < data.all().size(); ++i) {
    const Observation& row = data.all()[i];
    const auto at = static_cast<Eigen::Index>(i);
    WheelRow one;
    std::optional<double> said;
    if (row.channel == Channel::kYawRate) {
      one.kind = 1;
      said = wheels[row.drive].turn(row, ins.ins_latency_gyro * ins.ins_latency);
    } else if (row.channel == Channel::kAlong) {
      said = wheels[row.drive].speed(row, ins.ins_latency);
      // The way along the heading at the begin is a chord of the turn; its heading row is before.
      const double turned = state.predicted[at - 1] * (row.end - row.begin);
      if (said && std::abs(turned) > 1e-6) *said *= std::sin(turned) / turned;
    }
    if (!said) continue;
    one.block = row.block;
    one.wheels = *said;
    one.without = without[at];
    one.effect = state.predicted[at] - without[at];
    one.weight = 1.0 / (state.scales[at] * state.scales[at]);
    rows.push_back(one);
  }
  return rows;
}

/// How much of the effect is in the rows of which wheels can speak.
double showsIn(const Fitter& fitter, const FitState& state, const Eigen::VectorXd& without) {
  double shown = 0.0;
  double all = 0.0;
  for (Eigen::Index i = 0; i < without.size(); ++i) {
    const Channel channel = fitter.data().all()[static_cast<size_t>(i)].channel;
    const double size = std::pow((state.predicted[i] - without[i]) / state.scales[i], 2);
    all += size;
    if (channel != Channel::kAcross) shown += size;
  }
  return all > 0.0 ? shown / all : 0.0;
}

/// Whether an effect is one factor on driving or on turning, which the wheels' scales are, too.
bool isScale(const Effect& effect) {
  return contains(effect.search.nominal, "forward_gain") ||
         contains(effect.search.nominal, "yaw_gain");
}

/// Sums of products over rows of one kind and block.
struct Sums {
  double ww = 0.0, wp = 0.0, wd = 0.0, pp = 0.0, pd = 0.0, dd = 0.0;

  void add(const WheelRow& row) {
    ww += row.weight * row.wheels * row.wheels;
    wp += row.weight * row.wheels * row.without;
    wd += row.weight * row.wheels * row.effect;
    pp += row.weight * row.without * row.without;
    pd += row.weight * row.without * row.effect;
    dd += row.weight * row.effect * row.effect;
  }
  Sums operator-(const Sums& other) const {
    return {ww - other.ww, wp - other.wp, wd - other.wd,
            pp - other.pp, pd - other.pd, dd - other.dd};
  }
};
using SumsOfKinds = std::array<Sums, 2>;

/// Share s of the effect for which wheels = a (without + s effect) holds best, a by kind.
double shareOf(const SumsOfKinds& sums) {
  double share = 0.5;
  for (int round = 0; round < kRounds; ++round) {
    double pull = 0.0;
    double information = 0.0;
    for (const Sums& of : sums) {
      const double model = of.pp + 2.0 * share * of.pd + share * share * of.dd;
      if (!(model > 0.0)) continue;
      const double scale = (of.wp + share * of.wd) / model;
      pull += scale * of.wd - scale * scale * of.pd;
      information += scale * scale * of.dd;
    }
    if (!(information > 0.0)) return kNotMeasured;
    share = pull / information;
  }
  return share;
}

/// How much of the effect is no mere scale of the motion: the wheels' own scale is not known.
double unlikeScale(const SumsOfKinds& sums) {
  double own = 0.0;
  double all = 0.0;
  for (const Sums& of : sums) {
    all += of.dd;
    own += of.pp > 0.0 ? of.dd - of.pd * of.pd / of.pp : 0.0;
  }
  return all > 0.0 ? own / all : 0.0;
}

}  // namespace

std::optional<WheelWitness> wheelWitness(const Fitter& fitter, const FitState& state,
                                         const std::string& effect) {
  const std::vector<Drive>& drives = fitter.data().drives();
  if (effectNamed(effect).kind() != EffectKind::kVehicle || isScale(effectNamed(effect)) ||
      std::all_of(drives.begin(), drives.end(),
                  [](const Drive& drive) { return drive.encoders.empty(); }))
    return std::nullopt;
  const Eigen::VectorXd without = switchedOff(fitter, state, {effect}).predicted;
  const std::vector<WheelRow> rows = wheelRows(fitter, state, without);
  if (rows.size() < kLeastRows) return std::nullopt;
  std::map<int, SumsOfKinds> blocks;
  SumsOfKinds all;
  for (const WheelRow& row : rows) {
    blocks[row.block][row.kind].add(row);
    all[row.kind].add(row);
  }
  if (showsIn(fitter, state, without) < kShown) return std::nullopt;
  const double share = shareOf(all);
  if (!std::isfinite(share) || unlikeScale(all) < kUnlike || blocks.size() < 2) return std::nullopt;
  // Jackknife over blocks.
  double sum = 0.0;
  for (const auto& [block, of] : blocks)
    sum += std::pow(shareOf({all[0] - of[0], all[1] - of[1]}) - share, 2);
  const auto count = static_cast<double>(blocks.size());
  const double error = std::sqrt(sum * (count - 1.0) / count);
  if (!(error < kSharp)) return std::nullopt;
  const double half = studentQuantile(count - 1.0) * error;
  return WheelWitness{share, share - half, share + half};
}

}  // namespace tread::gap
