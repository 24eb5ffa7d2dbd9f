// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "modules/identification/core/discovery.hpp"
#include "modules/identification/core/end_errors.hpp"
#include "modules/identification/core/unnamed.hpp"
#include "nameless_drive.hpp"

// Unexplained residuals with a shape become an unnamed term of the model.

using namespace tread;
using namespace tread::gap;
using samples::frictionDrive;
using samples::kSilent;
using samples::Rig;
using samples::turningDrive;

namespace {

/// Result of find for a drive, with the errors on another one.
GapFinding findWithTest(const ModelDocument& model, const Drive& train, const Drive& test,
                        bool named_only = false) {
  GapTask task;
  task.model = model;
  task.train = {train};
  task.test = {test};
  task.test.front().name = "test";
  task.named_only = named_only;
  return findGap(task, kSilent);
}

/// Root mean square of the heading at the ends of executions with a model [rad].
double headingError(const ModelDocument& model, const Drive& drive) {
  const std::vector<Drive> drives{drive};
  const Observations data(drives, {});
  return summaryOf(endErrors(data, model)).yaw.rms;
}

}  // namespace

TEST_CASE("an effect without a name becomes a term that closes most of the gap on another drive") {
  constexpr double kTurns = 0.1;  // [s]
  const Drive test = turningDrive({}, kTurns, 22);
  const GapFinding found = findWithTest(syntheticVehicle(), turningDrive({}, kTurns, 21), test);
  REQUIRE_FALSE(found.identified.unnamed.empty());
  // The unnamed part is reported as such, even if a plain cause was also found.
  CHECK((found.verdict == GapVerdict::kNotInCatalogue || found.verdict == GapVerdict::kPartial));
  const std::vector<UnnamedTerm>& terms = found.identified.model.vehicle.unnamed;
  REQUIRE(terms.size() == found.identified.unnamed.size());
  CHECK(terms[0].name == "unnamed_1");
  CHECK(terms[0].channel == TermChannel::kYawRate);
  // The form itself: the square of the yaw rate, with either sign.
  for (const double side : {-0.6, 0.6}) {
    const TrackCommand spin{-side, side};
    const double plain = steadyTwist(syntheticVehicle().vehicle, spin).omega;
    const double with = steadyTwist(found.identified.model.vehicle, spin).omega;
    CHECK(with - plain == Approx(kTurns * plain * plain).epsilon(0.25));
  }
  const double floor = headingError(syntheticVehicle(), turningDrive({}, 0.0, 22));
  const double before = found.gap->before.yaw.rms;
  CHECK(before > 1.3 * floor);
  CHECK(found.gap->after.yaw.rms < floor + 0.3 * (before - floor));
  // The term has its numbers, and the covariance for holding them.
  CHECK(found.identified.unnamed[0].gain > kTermSure * found.identified.unnamed[0].gain_error);
  CHECK(found.identified.unnamed[0].deviations.size() == terms[0].values.size());
  CHECK_FALSE(found.identified.unnamed[0].data.empty());
  CHECK(std::isfinite(knownDeviation(found.identified.model, termPath(terms[0], 0))));
}

TEST_CASE("friction that brakes a turn faster than it winds up gets a term beside the names") {
  const Drive train = frictionDrive(0.5, 0.02, 31);
  const Drive test = frictionDrive(0.5, 0.02, 32);
  const GapFinding named = findWithTest(syntheticVehicle(), train, test, true);
  const GapFinding found = findWithTest(syntheticVehicle(), train, test);
  REQUIRE_FALSE(found.identified.unnamed.empty());
  CHECK(named.identified.unnamed.empty());
  CHECK(named.identified.model.vehicle.unnamed.empty());
  const double floor = headingError(syntheticVehicle(), frictionDrive(1e-6, 1e-6, 32));
  const double before = found.gap->before.yaw.rms;
  CAPTURE(floor, before, named.gap->after.yaw.rms, found.gap->after.yaw.rms);
  CHECK(found.gap->after.yaw.rms < named.gap->after.yaw.rms);
  CHECK(found.gap->after.yaw.rms < floor + 0.4 * (before - floor));
}

TEST_CASE("a vehicle that is as its model says gets no term") {
  for (uint64_t seed = 41; seed <= 46; ++seed) {
    const GapFinding found =
        findWithTest(syntheticVehicle(), turningDrive({}, 0.0, seed), turningDrive({}, 0.0, 1));
    CHECK(found.identified.unnamed.empty());
    CHECK(found.identified.model.vehicle.unnamed.empty());
  }
}

TEST_CASE("what a term of the model says is nothing new on the next drive") {
  constexpr double kTurns = 0.1;  // [s]
  const GapFinding first =
      findWithTest(syntheticVehicle(), turningDrive({}, kTurns, 21), turningDrive({}, kTurns, 22));
  const ModelDocument& model = first.identified.model;
  REQUIRE(model.vehicle.unnamed.size() == 1);
  for (uint64_t seed = 23; seed <= 25; ++seed) {
    const GapFinding again =
        findWithTest(model, turningDrive({}, kTurns, seed), turningDrive({}, kTurns, seed + 100));
    CHECK(exitStatus(again.verdict) == 0);
    CHECK(again.identified.unnamed.empty());
    CHECK(again.identified.moved_terms.empty());
    CHECK(again.identified.model.vehicle.unnamed.size() == 1);
  }
  const GapFinding moved =
      findWithTest(model, turningDrive({}, 4.0 * kTurns, 23), turningDrive({}, 4.0 * kTurns, 24));
  CHECK(exitStatus(moved.verdict) != 0);
  CHECK(moved.identified.moved_terms == std::vector<std::string>{"unnamed_1"});
  // The cause of the term has disappeared.
  const GapFinding gone = findWithTest(model, turningDrive({}, 0.0, 23), turningDrive({}, 0.0, 24));
  CHECK(exitStatus(gone.verdict) != 0);
  CHECK(gone.identified.moved_terms == std::vector<std::string>{"unnamed_1"});
}

TEST_CASE("no term is added on blocks that show none, and the state stays as it was") {
  const Rig rig({}, 300.0, 5);
  FitState state = rig.fitted({{"forward_gain", 0.95}, {"yaw_gain", 0.68}});
  const double loss = state.loss;
  CHECK_FALSE(addTerm(rig.fitter, state,
                      {TermChannel::kYawRate, TermChannel::kSpeed, TermChannel::kSideways},
                      kTermSure));
  CHECK(state.loss == loss);
  CHECK(state.free.size() == 2);
  CHECK(state.model.vehicle.unnamed.empty());
}

TEST_CASE("values of given terms are held by their covariance and by what they vary") {
  ModelDocument model = syntheticVehicle();
  UnnamedTerm term;
  term.name = "own_name";
  term.condition = findTermCondition("|v|");
  term.at = {0.0, 0.5, 1.0};
  term.values = {0.0, 0.05, 0.1};
  model.vehicle.unnamed = {term};
  model.covariance = {{"own_name.1", "own_name.2"}, {{0.0004, 0.0}, {0.0, 0.0009}}};
  const std::vector<FreeParameter> held = termParameters(model, false);
  REQUIRE(held.size() == 2);  // the value at 0 is fixed
  CHECK(held[0].path == "own_name.1");
  CHECK(held[0].expected == 0.05);
  CHECK(held[0].deviation == Approx(std::hypot(0.02, kTermVaries * 0.1)));
  CHECK(held[1].deviation == Approx(std::hypot(0.03, kTermVaries * 0.1)));
}
