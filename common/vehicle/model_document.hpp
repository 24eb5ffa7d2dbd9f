// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/vehicle/effects.hpp"
#include "common/vehicle/kernel.hpp"

namespace tread {

class ConfigReader;

/// Bounds for one parameter of a model, tighter than the catalogue's.
struct ParameterBounds {
  std::string parameter;  ///< see findParameter()
  double min = 0.0;
  double max = 0.0;
};

/// Covariance of parameters that were estimated together; empty = unknown.
struct ParameterCovariance {
  std::vector<std::string> parameters;      ///< see findParameter()
  std::vector<std::vector<double>> matrix;  ///< in the parameters' units, symmetric
};

/// What the model left unexplained when it was made: how its residuals (measured less predicted)
/// depended on one condition that tread-gap tests.
struct RestTerm {
  std::string channel;     ///< of the residuals: "yaw rate", "heading rate", "along", "lateral"
  std::string condition;   ///< "turns before", "v x yaw rate"
  double size = 0.0;       ///< [rad/s or m/s] per unit of the condition
  double deviation = 0.0;  ///< standard deviation of the size
};

/// A log from which a model was made.
struct SourceLog {
  std::string name;
  std::string sha256;  ///< 64 hexadecimal digits
};

/// A user's final decision on an effect of the catalogue.
struct EffectDecision {
  std::string effect;
  bool accepted = false;  ///< included whatever the tests give; else never considered
  std::string by;         ///< who decided; may be empty
};

/// Where a model comes from.
struct Provenance {
  std::string tool;             ///< name and version; empty = written by hand
  std::optional<int64_t> seed;  ///< of its random numbers
  int64_t runs = 0;             ///< number of tool runs on these logs
  std::vector<SourceLog> logs;
  std::vector<EffectDecision> decisions;
};

/// The largest motions that a model was made from, or that a drive demands.
struct Envelope {
  double v = 0.0;        ///< [m/s] largest |v|
  double omega = 0.0;    ///< [rad/s] largest |omega|
  double v_omega = 0.0;  ///< [m/s2] largest |v omega|

  void include(const Twist2& v_body);
};

/// Demands outside of an envelope; one line each, empty if there are none.
std::vector<std::string> warningsOutside(const Envelope& known, const Envelope& asked);

/// The content of a model file: a model and its provenance.
struct ModelDocument {
  VehicleModel vehicle;
  MeasurementModel measurement;
  std::vector<ParameterBounds> bounds;
  ParameterCovariance covariance;
  /// Empty if nothing was left unexplained; nullopt if unknown, as for a model made by hand.
  std::optional<std::vector<RestTerm>> rest;
  Provenance provenance;
  std::optional<Envelope> envelope;
};

/// Largest motions of a model driven by these commands, for warningsOutside().
Envelope envelopeOf(const VehicleModel& model, const std::vector<TrackCommand>& commands,
                    double period, const EntryState& entry);

/// The value of a parameter of an effect.
double& valueOf(ModelDocument& document, const EffectParameter& parameter);
double valueOf(const ModelDocument& document, const EffectParameter& parameter);

/// Whether a strength of the effect is not 0 in a model.
inline bool isOn(const Effect& effect, const ModelDocument& document) {
  return isOn(effect, document.vehicle.effects, document.measurement);
}

/// The number of a document with this path: lag, delay, forward_gain, yaw_gain, full_speed, gauge,
/// effect.parameter (icr_offset.offset), rest.0, rest.1 .. (the size of a term of the rest), or
/// unnamed_1.0, unnamed_1.1 .. (the values of an unnamed term); nullptr for anything else.
double* findParameter(ModelDocument& document, const std::string& path);
const double* findParameter(const ModelDocument& document, const std::string& path);

/// Numbers of the nominal model that a calibration of such a vehicle estimates.
std::vector<std::string> calibratedNumbers(VehicleLayout layout);

/// The path of a term of the rest, and the term of a path; nullopt for another path.
std::string restPath(size_t term);
std::optional<size_t> restTermOf(const std::string& path);

/// The unnamed term that a path refers to; nullptr for another path.
const UnnamedTerm* termOfPath(const ModelDocument& document, const std::string& path);

/// The path of a value of an unnamed term.
std::string termPath(const UnnamedTerm& term, size_t value);

/// What is wrong with a name for an unnamed term of a model; empty if it is valid.
std::string problemWithTermName(const ModelDocument& document, const std::string& name);

/// Renames an unnamed term, also in the covariance and the bounds.
/** Throws std::runtime_error with one line if the model has no such term or the name is not
 * allowed. */
void renameTerm(ModelDocument& document, const std::string& from, const std::string& to);

/// Its unit.
std::string unitOf(const std::string& path);

/// Plausible range of a parameter: the document's bounds, else the catalogue's; an effect that is
/// added to a number of the model cannot make it negative. nullopt for numbers of the nominal model
/// without bounds.
std::optional<ParameterBounds> plausibleBounds(const ModelDocument& document,
                                               const std::string& path);

}  // namespace tread
