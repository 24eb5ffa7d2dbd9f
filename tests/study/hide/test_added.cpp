// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Effects from files are hidden by their formulas.
#include <fstream>
#include <string>

#include <catch2/catch.hpp>

#include "tests/study/hide/blind_bench.hpp"

using namespace tread;
using namespace tread::blind;
using tread::blind::bench::steadyTwist;

namespace {

void addFile(const std::string& name, const std::string& law, const std::string& parameter) {
  const bench::Folder folder;
  const std::string path = folder.path(name + ".yaml");
  std::ofstream(path) << "name: " << name << "\n"
                      << law << "\nparameters:\n  - " << parameter << "\n";
  addEffectOfFile(path);
}

}  // namespace

TEST_CASE("the formula of a file is put on the motion of the ground truth") {
  const std::string drag = "{name: p, unit: '1', min: 0, max: 1, typical: 0.2}";
  addFile("own_drag", "changes: v\nto: v - p * v * abs(v)", drag);
  const double plain = steadyTwist({}, 0.0, {0.6, 0.6}).v_x;
  CHECK(steadyTwist({"own_drag"}, 2.0, {0.6, 0.6}).v_x ==
        Approx(plain - 0.2 * plain * plain).epsilon(1e-3));
  addFile("own_memory",
          "changes: yaw_rate\nmemory_follows: v\nmemory_over: 0.3\n"
          "to: yaw_rate + p * memory",
          drag);
  CHECK(steadyTwist({"own_memory"}, 2.0, {0.6, 0.6}).omega == Approx(0.2 * plain).epsilon(1e-2));
  addFile("own_left", "changes: track\nto: 'side > 0 ? speed * (1 - p) : speed'", drag);
  const Twist2 turned = steadyTwist({"own_left"}, 2.0, {0.6, 0.6});
  CHECK(turned.omega > 0.05);
  CHECK(turned.v_x == Approx(0.9 * plain).epsilon(0.02));
}

TEST_CASE("a file whose effect can be hidden already, or is none, is refused") {
  const std::string p = "{name: p, unit: '1', min: 0, max: 1, typical: 0.2}";
  CHECK_THROWS_WITH(addFile("slip_ratio", "changes: v\nto: v - p * v", p),
                    Catch::Contains("can be hidden already"));
  addFile("misspelt", "changes: v\nto: v - p * vv", p);
  CHECK_THROWS_WITH(steadyTwist({"misspelt"}, 2.0, {0.6, 0.6}), Catch::Contains("v - p * vv"));
}

TEST_CASE("a motor is limited in one direction of one side") {
  int limited = 0;
  for (const double left : {-0.8, 0.8})
    for (const double right : {-0.8, 0.8}) {
      const Twist2 plain = steadyTwist({}, 0.0, {left, right});
      const Twist2 with = steadyTwist({"motor_limit"}, 4.0, {left, right});
      limited += std::abs(with.v_x - plain.v_x) > 0.05 ? 1 : 0;
    }
  CHECK(limited == 2);
}
