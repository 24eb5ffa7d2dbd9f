// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/plan_design.hpp"

#include <algorithm>

#include "tools/gap/core/search.hpp"
#include "tools/gap/model_change.hpp"
#include "tools/gap/plan_rival.hpp"

namespace tread::gap {
namespace {

/// Effects that begin at a moment have begun.
void beginAtOnce(ModelDocument& model, const Effect& effect) {
  for (const EffectParameter& parameter : effect.parameters)
    if (parameter.role == ParameterRole::kShape && parameter.name.rfind("time", 0) == 0 &&
        parameter.name != "time_constant")
      *findParameter(model, effect.name + "." + parameter.name) = 0.0;
}

ModelDocument truthOf(const DesignTask& task) {
  ModelDocument model = task.model;
  const Effect& truth = effectNamed(task.truth);
  if (!isOn(model, truth)) turnOn(model, truth);
  turnOff(model, effectNamed(task.rival));
  beginAtOnce(model, truth);
  return model;
}

/// B switched on at several sizes: a fit may end in different places.
std::vector<Rival> rivalsOf(const DesignTask& task) {
  ModelDocument model = task.model;
  turnOff(model, effectNamed(task.truth));
  const Effect& rival = effectNamed(task.rival);
  turnOn(model, rival);
  beginAtOnce(model, rival);
  std::vector<FreeParameter> free = givenParameters(model, false);
  for (const EffectParameter& parameter : rival.parameters) {
    const std::string path = rival.name + "." + parameter.name;
    const bool known = std::any_of(free.begin(), free.end(),
                                   [&](const FreeParameter& other) { return other.path == path; });
    if (!known && parameter.role == ParameterRole::kStrength)
      free.push_back(freeParameter(model, path));
  }
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

/// Chooses manoeuvres.
class Designer {
 public:
  explicit Designer(const DesignTask& task) : task_(task), starts_(rivalsOf(task)) {
    design_.truth = truthOf(task);
    for (const Manoeuvre& manoeuvre : task.manoeuvres)
      probes_.emplace_back(design_.truth, manoeuvre, task.noise);
  }

  Design run() {
    design_.counts.assign(probes_.size(), 0);
    ModelDocument without = design_.truth;
    turnOff(without, effectNamed(task_.truth));
    for (const Probe& probe : probes_) design_.visible += 0.5 * probe.missed(without).squaredNorm();
    Rival rival = starts_.front();
    fitBest(std::vector<size_t>(probes_.size(), 1), rival);
    while (design_.difference < task_.enough && addWorst(rival)) {
      design_.difference = rival.fit(probes_, design_.counts);
      if (design_.difference >= task_.enough) design_.difference = fitBest(design_.counts, rival);
    }
    design_.separates = design_.difference >= task_.enough;
    if (design_.separates) leaveOut(rival);
    design_.rival = rival.model();
    return design_;
  }

 private:
  double fitBest(const std::vector<size_t>& counts, Rival& best) const {
    double least = best.fit(probes_, counts);
    for (Rival start : starts_) {
      const double loss = start.fit(probes_, counts);
      if (loss >= least) continue;
      least = loss;
      best = start;
    }
    return least;
  }

  /// Adds the manoeuvre on which B is worst per second; false if there is no time for one.
  bool addWorst(const Rival& rival) {
    double best = 0.0;
    size_t chosen = probes_.size();
    for (size_t i = 0; i < probes_.size(); ++i) {
      if (design_.duration + probes_[i].duration() > task_.longest) continue;
      const double gained = probes_[i].missed(rival.model()).squaredNorm() / probes_[i].duration();
      if (gained <= best) continue;
      best = gained;
      chosen = i;
    }
    if (chosen == probes_.size()) return false;
    ++design_.counts[chosen];
    design_.duration += probes_[chosen].duration();
    return true;
  }

  void leaveOut(Rival& rival) {
    for (size_t i = 0; i < probes_.size(); ++i)
      while (design_.counts[i] > 0) {
        std::vector<size_t> fewer = design_.counts;
        --fewer[i];
        Rival other = rival;
        const double difference = fitBest(fewer, other);
        if (difference < task_.enough) break;
        design_.counts = fewer;
        design_.duration -= probes_[i].duration();
        design_.difference = difference;
        rival = other;
      }
  }

  const DesignTask& task_;
  std::vector<Probe> probes_;
  std::vector<Rival> starts_;
  Design design_;
};

}  // namespace

Design designDrive(const DesignTask& task) {
  return Designer(task).run();
}

}  // namespace tread::gap
