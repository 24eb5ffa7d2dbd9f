// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors

#include "tools/lab/gap/plan_design.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "modules/identification/core/candidates.hpp"
#include "modules/identification/core/fit.hpp"
#include "modules/identification/core/pruning.hpp"
#include "tools/lab/gap/what_if.hpp"

namespace tread::gap {
namespace {

constexpr size_t kSamples = 10;  // commands between two observations: half a second

/// Half an hour into a session: time-dependent effects are present and nearly constant.
Circumstances circumstances() {
  Circumstances late;
  late.session_time = 1800.0;
  late.worked = 0.5;
  return late;
}

ExecutionSpread spreadOf(const VehicleModel& vehicle) {
  ExecutionSpread spread = vehicle.spread;
  if (spread.forward <= 0.0) spread.forward = 0.03;
  if (spread.yaw <= 0.0) spread.yaw = 0.03;
  if (spread.crab <= 0.0) spread.crab = 0.017;
  return spread;
}

/// Pose and mean yaw rate of each half second, stacked.
Eigen::VectorXd observed(const ModelDocument& model, const Manoeuvre& manoeuvre,
                         const ExecutionNoise& noise = {}) {
  const std::vector<MotionSample> motion = drivenByModel(model, manoeuvre, circumstances(), noise);
  std::vector<double> values;
  double turned = 0.0;
  size_t held = 0;
  for (size_t i = 1; i < motion.size(); ++i) {
    turned += 0.5 * (motion[i - 1].omega + motion[i].omega);
    ++held;
    if (i % kSamples != 0 && i + 1 != motion.size()) continue;
    const Pose2& pose = motion[i].T_map_body;
    values.insert(values.end(), {pose.x, pose.y, pose.yaw, turned / static_cast<double>(held)});
    turned = 0.0;
    held = 0;
  }
  return Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// Effect of an error of the start pose on all later poses.
Eigen::MatrixXd startErrors(const Eigen::VectorXd& values, const InsNoise& noise) {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(values.size(), 3);
  for (Eigen::Index i = 0; i + 3 < values.size(); i += 4) {
    columns(i, 0) = noise.fix;
    columns(i + 1, 1) = noise.fix;
    columns(i, 2) = -values[i + 1] * noise.heading;
    columns(i + 1, 2) = values[i] * noise.heading;
    columns(i + 2, 2) = noise.heading;
  }
  return columns;
}

Eigen::MatrixXd noiseOf(const ModelDocument& model, const Manoeuvre& manoeuvre,
                        const Eigen::VectorXd& mean, const InsNoise& ins) {
  const ExecutionSpread spread = spreadOf(model.vehicle);
  const ExecutionNoise along{1.0 + spread.forward, 1.0, 0.0};
  const ExecutionNoise turning{1.0, 1.0 + spread.yaw, 0.0};
  const ExecutionNoise across{1.0, 1.0, spread.crab};
  Eigen::VectorXd own(mean.size());
  for (Eigen::Index i = 0; i < own.size(); ++i)
    own[i] = i % 4 < 2 ? ins.fix : i % 4 == 2 ? ins.heading : ins.gyro;
  Eigen::MatrixXd covariance = own.array().square().matrix().asDiagonal();
  for (const ExecutionNoise& noise : {along, turning, across}) {
    const Eigen::VectorXd change = observed(model, manoeuvre, noise) - mean;
    covariance += change * change.transpose();
  }
  const Eigen::MatrixXd start = startErrors(mean, ins);
  return covariance + start * start.transpose();
}

/// A manoeuvre with its true outcome and the whitening of differences.
/** It compares poses and mean yaw rates each half second. The noise has two parts: the model's
 * spread between executions, constant within one (3 %, 3 % and 1 deg if not stated), and INS
 * noise, also on the start pose. */
class Probe {
 public:
  Probe(const ModelDocument& truth, const Manoeuvre& manoeuvre, const InsNoise& ins)
      : manoeuvre_(manoeuvre),
        wanted_(observed(truth, manoeuvre)),
        noise_(noiseOf(truth, manoeuvre, wanted_, ins)) {}

  /// Difference of a model from the truth in units of noise.
  Eigen::VectorXd missed(const ModelDocument& model) const {
    return noise_.matrixL().solve(observed(model, manoeuvre_) - wanted_);
  }
  /// [s]
  double duration() const {
    return kManoeuvrePeriod * static_cast<double>(manoeuvre_.commands.size());
  }

 private:
  Manoeuvre manoeuvre_;
  Eigen::VectorXd wanted_;
  Eigen::LLT<Eigen::MatrixXd> noise_;
};

/// A model that is refitted to imitate the truth.
class Rival {
 public:
  Rival(ModelDocument model, std::vector<FreeParameter> free)
      : model_(std::move(model)), free_(std::move(free)) {}

  /// Refits on each manoeuvre with its count, from the present values. Returns the remaining
  /// difference plus the cost of the priors [nats].
  double fit(const std::vector<Probe>& probes, const std::vector<size_t>& counts) {
    constexpr int kIterations = 12;
    constexpr double kStuck = 1e6;
    double damping = 1e-3;
    double loss = lossOf(model_, probes, counts);
    for (int i = 0; i < kIterations && damping < kStuck; ++i) {
      Eigen::MatrixXd information;
      Eigen::VectorXd pull;
      linearise(probes, counts, information, pull);
      const double before = loss;
      while (damping < kStuck && !step(information, pull, damping, probes, counts, loss))
        damping *= 10.0;
      damping *= 0.1;
      if (before - loss < 1e-6 * (1.0 + before)) break;
    }
    return loss;
  }

  const ModelDocument& model() const { return model_; }

 private:
  double priorLoss(const ModelDocument& model) const {
    double sum = 0.0;
    for (const FreeParameter& parameter : free_) {
      const double off = *findParameter(model, parameter.path) - parameter.expected;
      if (std::isfinite(parameter.deviation)) sum += 0.5 * std::pow(off / parameter.deviation, 2);
    }
    return sum;
  }

  double lossOf(const ModelDocument& model, const std::vector<Probe>& probes,
                const std::vector<size_t>& counts) const {
    double sum = priorLoss(model);
    for (size_t i = 0; i < probes.size(); ++i)
      if (counts[i] > 0)
        sum += 0.5 * static_cast<double>(counts[i]) * probes[i].missed(model).squaredNorm();
    return sum;
  }

  Eigen::MatrixXd columnsOf(const Probe& probe, const Eigen::VectorXd& missed) const {
    Eigen::MatrixXd columns(missed.size(), static_cast<Eigen::Index>(free_.size()));
    for (size_t j = 0; j < free_.size(); ++j) {
      ModelDocument moved = model_;
      double& value = *findParameter(moved, free_[j].path);
      const double by = value + free_[j].step <= free_[j].max ? free_[j].step : -free_[j].step;
      value += by;
      columns.col(static_cast<Eigen::Index>(j)) = (probe.missed(moved) - missed) / by;
    }
    return columns;
  }

  void linearise(const std::vector<Probe>& probes, const std::vector<size_t>& counts,
                 Eigen::MatrixXd& information, Eigen::VectorXd& pull) const {
    const auto size = static_cast<Eigen::Index>(free_.size());
    information = Eigen::MatrixXd::Zero(size, size);
    pull = Eigen::VectorXd::Zero(size);
    for (size_t i = 0; i < probes.size(); ++i) {
      if (counts[i] == 0) continue;
      const auto times = static_cast<double>(counts[i]);
      const Eigen::VectorXd missed = probes[i].missed(model_);
      const Eigen::MatrixXd columns = columnsOf(probes[i], missed);
      information += times * columns.transpose() * columns;
      pull += times * columns.transpose() * missed;
    }
    for (size_t j = 0; j < free_.size(); ++j) {
      if (!std::isfinite(free_[j].deviation)) continue;
      const auto at = static_cast<Eigen::Index>(j);
      const double precision = 1.0 / (free_[j].deviation * free_[j].deviation);
      information(at, at) += precision;
      pull[at] += precision * (*findParameter(model_, free_[j].path) - free_[j].expected);
    }
  }

  /// One damped step; false if it does not improve.
  bool step(const Eigen::MatrixXd& information, const Eigen::VectorXd& pull, double damping,
            const std::vector<Probe>& probes, const std::vector<size_t>& counts, double& loss) {
    Eigen::MatrixXd damped = information;
    for (size_t j = 0; j < free_.size(); ++j) {
      const auto at = static_cast<Eigen::Index>(j);
      damped(at, at) += damping * damped(at, at) + 1e-12 / (free_[j].step * free_[j].step);
    }
    const Eigen::VectorXd change = damped.ldlt().solve(-pull);
    ModelDocument moved = model_;
    for (size_t j = 0; j < free_.size(); ++j) {
      double& value = *findParameter(moved, free_[j].path);
      value = std::clamp(value + change[static_cast<Eigen::Index>(j)], free_[j].min, free_[j].max);
    }
    const double tried = lossOf(moved, probes, counts);
    if (!(tried < loss)) return false;
    loss = tried;
    model_ = moved;
    return true;
  }

  ModelDocument model_;
  std::vector<FreeParameter> free_;
};

/// Moves an effect's change point before the beginning.
void beginAtOnce(ModelDocument& model, const Effect& effect) {
  for (const ChangePoint& change : effect.search.change_points)
    *findParameter(model, effect.name + "." + change.time) = 0.0;
}

/// The model with the first effect and without the second.
ModelDocument modelWith(const ModelDocument& model, const std::string& there,
                        const std::string& gone) {
  ModelDocument with = model;
  const Effect& effect = effectNamed(there);
  if (!isOn(effect, with)) turnOn(with, effect);
  turnOff(with, effectNamed(gone));
  beginAtOnce(with, effect);
  return with;
}

/// The rival effect at several initial sizes, because a fit may end in different local minima.
std::vector<Rival> rivalsOf(ModelDocument model, const std::string& there,
                            const std::string& gone) {
  turnOff(model, effectNamed(gone));
  const Effect& rival = effectNamed(there);
  turnOn(model, rival);
  beginAtOnce(model, rival);
  std::vector<FreeParameter> free = givenParameters(model, false);
  // No prior for the rival's size, even if the model has one.
  free.erase(std::remove_if(free.begin(), free.end(),
                            [&rival](const FreeParameter& known) {
                              return effectOf(known.path) == rival.name;
                            }),
             free.end());
  for (const EffectParameter& parameter : rival.parameters)
    if (parameter.role == ParameterRole::kStrength)
      free.push_back(freeParameter(model, rival.name + "." + parameter.name));
  const EffectParameter& first = rival.parameters.front();
  std::vector<double> sizes = first.probes;
  for (const double factor : {1.0, 0.1, -0.1, -1.0}) sizes.push_back(factor * first.typical);
  std::vector<Rival> rivals;
  for (const double size : sizes) {
    if (size < first.min || size > first.max) continue;
    *findParameter(model, rival.name + "." + first.name) = size;
    rivals.emplace_back(model, free);
  }
  return rivals;
}

/// One case: this effect is present, the other one imitates it.
class Side {
 public:
  Side(const DesignTask& task, const std::string& truth, const std::string& rival)
      : true_model_(modelWith(task.model, truth, rival)),
        starts_(rivalsOf(task.model, rival, truth)),
        rival_(starts_.front()),
        names_{truth, rival} {
    for (const Manoeuvre& manoeuvre : task.manoeuvres)
      probes_.emplace_back(true_model_, manoeuvre, task.noise);
    rival_ = bestOn(std::vector<size_t>(probes_.size(), 1));
    difference_ = 0.0;
  }

  const std::vector<Probe>& probes() const { return probes_; }
  double difference() const { return difference_; }
  /// Remaining difference of the rival on a manoeuvre, per second.
  double missedPerSecond(size_t probe) const {
    return probes_[probe].missed(rival_.model()).squaredNorm() / probes_[probe].duration();
  }

  /// Refits the rival; from all initial sizes only if the nearest fit exceeds `enough`.
  void follow(const std::vector<size_t>& counts, double enough) {
    difference_ = rival_.fit(probes_, counts);
    if (difference_ >= enough) rival_ = bestOn(counts);
  }

  DesignSide summary() const {
    ModelDocument without = true_model_;
    turnOff(without, effectNamed(names_.first));
    double visible = 0.0;
    for (const Probe& probe : probes_) visible += 0.5 * probe.missed(without).squaredNorm();
    return {names_.first, names_.second, true_model_, rival_.model(), difference_, visible};
  }

 private:
  /// The best fit from the present values and from all initial sizes; stores its difference.
  Rival bestOn(const std::vector<size_t>& counts) {
    Rival best = rival_;
    difference_ = best.fit(probes_, counts);
    for (Rival start : starts_) {
      const double loss = start.fit(probes_, counts);
      if (loss >= difference_) continue;
      difference_ = loss;
      best = start;
    }
    return best;
  }

  ModelDocument true_model_;
  std::vector<Rival> starts_;
  Rival rival_;
  std::pair<std::string, std::string> names_;
  std::vector<Probe> probes_;
  double difference_ = 0.0;
};

/// Selects manoeuvres.
class Designer {
 public:
  explicit Designer(const DesignTask& task) : task_(task), counts_(task.manoeuvres.size(), 0) {
    const auto [one, other] = std::minmax(task.first, task.second);
    sides_.emplace_back(task, one, other);
    sides_.emplace_back(task, other, one);
  }

  Design run() {
    while (!enough(sides_) && addWorst())
      for (Side& side : sides_) side.follow(counts_, task_.enough);
    const bool separates = enough(sides_);
    if (separates) leaveOut();
    Design design{counts_, duration_, {}, separates};
    for (const Side& side : sides_) design.sides.push_back(side.summary());
    return design;
  }

 private:
  bool enough(const std::vector<Side>& sides) const {
    return std::all_of(sides.begin(), sides.end(),
                       [this](const Side& side) { return side.difference() >= task_.enough; });
  }

  /// Adds the manoeuvre with the largest difference for the harder side; false if none fits into
  /// the time.
  bool addWorst() {
    const Side& harder = sides_[0].difference() <= sides_[1].difference() ? sides_[0] : sides_[1];
    double best = 0.0;
    size_t chosen = counts_.size();
    for (size_t i = 0; i < counts_.size(); ++i) {
      if (duration_ + harder.probes()[i].duration() > task_.longest) continue;
      const double gained = harder.missedPerSecond(i);
      if (gained <= best) continue;
      best = gained;
      chosen = i;
    }
    if (chosen == counts_.size()) return false;
    ++counts_[chosen];
    duration_ += harder.probes()[chosen].duration();
    return true;
  }

  void leaveOut() {
    for (size_t i = 0; i < counts_.size(); ++i)
      while (counts_[i] > 0) {
        std::vector<size_t> fewer = counts_;
        --fewer[i];
        std::vector<Side> others = sides_;
        for (Side& side : others) side.follow(fewer, task_.enough);
        if (!enough(others)) break;
        counts_ = fewer;
        duration_ -= sides_[0].probes()[i].duration();
        sides_ = others;
      }
  }

  const DesignTask& task_;
  std::vector<Side> sides_;
  std::vector<size_t> counts_;
  double duration_ = 0.0;
};

}  // namespace

const DesignSide& Design::harder() const {
  return sides[0].difference <= sides[1].difference ? sides[0] : sides[1];
}

Design designDrive(const DesignTask& task) {
  return Designer(task).run();
}

}  // namespace tread::gap
