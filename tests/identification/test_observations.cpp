// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "core_rig.hpp"

using namespace tread;
using namespace tread::gap;
using samples::vehicleWith;

TEST_CASE("what data should be does not depend on the pieces of the simulation") {
  const ModelDocument model = vehicleWith({{"yaw_inertia.lag", 0.03}, {"body_inertia.lag", 0.03}});
  const std::vector<Drive> drives{syntheticDrive(model, 60.0, 1)};
  ObservationSettings fine;
  fine.piece = 0.002;
  const Eigen::VectorXd exact = Observations(drives, fine).predict(model);
  const Eigen::VectorXd usual = Observations(drives, {}).predict(model);
  REQUIRE(usual.size() == exact.size());
  // Rates of up to 1 m/s and 1.7 rad/s; interpolated in the pieces they would be off by .01.
  CHECK((usual - exact).cwiseAbs().maxCoeff() < 2e-3);
}
