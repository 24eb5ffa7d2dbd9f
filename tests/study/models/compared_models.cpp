// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/models/compared_models.hpp"

#include <algorithm>
#include <iterator>

#include "modules/identification/core/candidates.hpp"
#include "tests/study/models/twist_dictionary.hpp"
#include "tests/study/rivals/rivals.hpp"

namespace tread::gap {
namespace {

constexpr double kFirstLag = 0.2;    // [s] initial value of fits
constexpr double kFirstDelay = 0.1;  // [s]
constexpr double kBites = 1.0;       // [nats] least gain of a speed limit
constexpr double kSlipPrior = 1.0;   // [m/s or rad/s], wide
constexpr double kRidges[] = {3.0, 1.0, 0.3, 0.1, 0.03, 0.01, 0.003};  // [m/s or rad/s]

std::vector<FreeParameter> freeParameters(const ModelDocument& model,
                                          const std::vector<std::string>& paths) {
  std::vector<FreeParameter> free;
  for (const std::string& path : paths) free.push_back(freeParameter(model, path));
  return free;
}

/// Alternates fit and noise: the noise of a worse fit is too large.
void settle(const Fitter& fitter, FitState& state) {
  fitter.fitRoughly(state);
  fitter.renewNoise(state);
  fitter.fit(state);
}

/// The fits for one set of rows, each starting from the previous one.
class Climb {
 public:
  explicit Climb(const Fitter& fitter) : fitter_(fitter) {}

  FitState gains(const ModelDocument& ideal) const {
    FitState state = fitter_.start(
        ideal,
        freeParameters(ideal, {"slip_ratio.slip", "track_width.widening", "ins_latency.latency"}));
    settle(fitter_, state);
    return state;
  }

  FitState lags(FitState state) const {
    add(state, "actuator_lag.lag", std::max(0.0, kFirstLag - state.model.vehicle.lag));
    add(state, "command_delay.delay", std::max(0.0, kFirstDelay - state.model.vehicle.delay));
    settle(fitter_, state);
    return state;
  }

  /// An inactive limit has no gradient, so several start values are tried.
  FitState limit(const FitState& state) const {
    const double most = excitationOf(fitter_.data(), state.model).track_speed;
    FitState best = state;
    for (double share : {0.92, 0.8, 0.65, 0.45}) {
      FitState tried = state;
      add(tried, "speed_saturation.inverse_limit", 1.0 / std::max(1e-3, share * most));
      fitter_.fitRoughly(tried);
      if (tried.loss < best.loss && tried.loss < state.loss - kBites) best = tried;
    }
    settle(fitter_, best);
    return best;
  }

  FitState asymmetry(FitState state) const {
    add(state, "track_asymmetry.share", 0.0);
    add(state, "icr_offset.offset", 0.0);
    settle(fitter_, state);
    return state;
  }

 private:
  void add(FitState& state, const std::string& path, double value) const {
    fitter_.add(state, freeParameter(state.model, path), value);
  }

  const Fitter& fitter_;
};

RungModel rungOf(const FitState& state) {
  RungModel rung;
  rung.model = state.model;
  for (const FreeParameter& parameter : state.free)
    rung.numbers.emplace_back(parameter.path, *findParameter(state.model, parameter.path));
  return rung;
}

RungModel corrected(const FitState& state, TwistRegression correction) {
  RungModel rung = rungOf(state);
  rung.correction = std::move(correction);
  return rung;
}

/// Coefficients of a regression in SI units, in addition to earlier fits.
void addCoefficients(RungModel& rung) {
  const char* const kParts[] = {"forward", "sideways", "turning"};
  for (size_t i = 0; i < rung.correction.terms.size(); ++i) {
    const TwistTerm& term = rung.correction.terms[i];
    rung.numbers.emplace_back(
        std::string(kParts[static_cast<size_t>(term.part)]) + " ~ " + term.name,
        rung.correction.coefficients[static_cast<Eigen::Index>(i)]);
  }
}

RungModel rivalRung(const rivals::Answer& answer) {
  RungModel rung;
  rung.model = answer.model;
  for (const std::string& path : answer.estimated) {
    rung.numbers.emplace_back(path, *findParameter(answer.model, path));
    // The data do not determine the hardness of an inactive limit.
    const EffectParameter* known = findEffectParameter(path);
    const bool is_size = known == nullptr || known->role == ParameterRole::kStrength;
    if (is_size && runsToBound(answer.model, freeParameter(answer.model, path)))
      rung.at_end.push_back(path);
  }
  for (const ParameterEstimate& named : answer.parameters)
    if (!contains(rung.effects, effectOf(named.parameter)))
      rung.effects.push_back(effectOf(named.parameter));
  return rung;
}

/// Lag, delay and gains of a fit as numbers of the nominal model.
ModelDocument numbersOf(const ModelDocument& ideal, const FitState& fitted) {
  const VehicleModel& vehicle = fitted.model.vehicle;
  ModelDocument model = ideal;
  model.vehicle.lag = vehicle.driveLag();
  model.vehicle.delay = vehicle.commandDelay();
  model.vehicle.forward_gain *= 1.0 - vehicle.effects.slip_ratio;
  model.vehicle.yaw_gain *=
      (1.0 - vehicle.effects.slip_ratio) / (1.0 + vehicle.effects.track_width);
  return model;
}

constexpr const char* kNames[kRungs] = {"ideal",           "gain + track", "powertrain + ICR",
                                        "slip regression", "black box",    "all parameters",
                                        "sparse",          "discovered"};
constexpr const char* kKeys[kRungs] = {
    "ideal",     "gain_track",     "powertrain_icr",    "slip_regression",
    "black_box", "all_parameters", "sparse_regression", "discovered"};

}  // namespace

const char* rungName(Rung rung) {
  return kNames[static_cast<size_t>(rung)];
}

const char* rungKey(Rung rung) {
  return kKeys[static_cast<size_t>(rung)];
}

RungModels fitRungs(const Fitter& fitter, const ModelDocument& ideal, bool ideal_known,
                    const Progress& say) {
  RungModels models;
  const auto set = [&models](Rung rung, RungModel model) {
    models[static_cast<size_t>(rung)] = std::move(model);
  };
  const Climb climb(fitter);
  if (ideal_known) set(Rung::kIdeal, {ideal, {}, {}, {}, {}});
  say("  gain, track, powertrain, ICR");
  const FitState gains = climb.gains(ideal);
  set(Rung::kGains, rungOf(gains));
  const FitState lagged = climb.lags(gains);
  const FitState limited = climb.limit(lagged);
  const FitState powertrain = climb.asymmetry(limited);
  set(Rung::kPowertrain, rungOf(powertrain));
  say("  slip regression, black box");
  RungModel slip =
      corrected(limited, fitRegression(fitter, limited.model, slipTerms(), {{kSlipPrior}, false}));
  addCoefficients(slip);
  set(Rung::kSlipRegression, std::move(slip));
  RungModel box =
      corrected(powertrain, fitRegression(fitter, powertrain.model, blackBoxTerms(),
                                          {{std::begin(kRidges), std::end(kRidges)}, true}));
  box.numbers.emplace_back("ridge", box.correction.deviation);
  set(Rung::kBlackBox, std::move(box));
  say("  all parameters, sparse regression");
  const ModelDocument numbers = numbersOf(ideal, lagged);
  set(Rung::kAllParameters, rivalRung(rivals::allParameters(fitter, numbers, true)));
  set(Rung::kSparse, rivalRung(rivals::sparseRegression(fitter, numbers, true)));
  return models;
}

ModelDocument calibratedNumbers(const Fitter& fitter, const ModelDocument& ideal) {
  const Climb climb(fitter);
  return numbersOf(ideal, climb.lags(climb.gains(ideal)));
}

FoundTerms discover(const Fitter& fitter, const ModelDocument& begin, uint64_t seed,
                    const Progress& say) {
  SearchSettings settings;
  settings.seed = seed;
  settings.calibrate = true;
  SearchMemory memory;  // separate: without knowledge of other driving
  return search(fitter, begin, settings, memory, say);
}

RungModel discoveredRung(const FoundTerms& found, const FitState& state) {
  RungModel rung = rungOf(state);
  rung.effects = found.effects;
  return rung;
}

std::vector<ExecutionError> endErrors(const Observations& data, const RungModel& rung) {
  return endErrors(data, simulateCorrected(data, rung.model.vehicle, rung.correction),
                   rung.model.measurement);
}

}  // namespace tread::gap
