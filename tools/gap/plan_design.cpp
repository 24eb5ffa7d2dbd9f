// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/plan_design.hpp"

#include <algorithm>
#include <utility>

#include "modules/identification/core/search.hpp"
#include "tools/gap/model_change.hpp"
#include "tools/gap/plan_rival.hpp"

namespace tread::gap {
namespace {

/// Effects with a change point have changed.
void beginAtOnce(ModelDocument& model, const Effect& effect) {
  for (const ChangePoint& change : effect.search.change_points)
    *findParameter(model, effect.name + "." + change.time) = 0.0;
}

/// The model with one of the two effects and without the other.
ModelDocument modelWith(const ModelDocument& model, const std::string& there,
                        const std::string& gone) {
  ModelDocument with = model;
  const Effect& effect = effectNamed(there);
  if (!isOn(effect, with)) turnOn(with, effect);
  turnOff(with, effectNamed(gone));
  beginAtOnce(with, effect);
  return with;
}

/// A rival switched on at several sizes: a fit may end in different places.
std::vector<Rival> rivalsOf(ModelDocument model, const std::string& there,
                            const std::string& gone) {
  turnOff(model, effectNamed(gone));
  const Effect& rival = effectNamed(there);
  turnOn(model, rival);
  beginAtOnce(model, rival);
  std::vector<FreeParameter> free = givenParameters(model, false);
  // The rival may take any size, whatever the model says of it.
  free.erase(std::remove_if(free.begin(), free.end(),
                            [&rival](const FreeParameter& known) {
                              return known.path.compare(0, rival.name.size() + 1,
                                                        rival.name + ".") == 0;
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

/// One effect is there, the other one tries to look like it.
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
  /// How badly the rival does on a manoeuvre, per second.
  double missedPerSecond(size_t probe) const {
    return probes_[probe].missed(rival_.model()).squaredNorm() / probes_[probe].duration();
  }

  /// Refits the rival; from all sizes only where the nearest fit would be enough.
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
  /// The best of fits from where the rival stands and from all sizes; its difference is kept.
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

/// Chooses manoeuvres.
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

  /// Adds the manoeuvre on which the harder side's rival is worst; false if there is no time for
  /// one.
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
