// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Section V of the paper on the two calibrations, with fewer repetitions and sets of recordings
// than a report.
#include <cmath>

#include <catch2/catch.hpp>

#include "tests/tools/lab/experiment/small_world.hpp"
#include "tools/lab/experiment/batch.hpp"
#include "tools/lab/experiment/text_tables.hpp"

namespace tread::experiment {
namespace {

using namespace testing;

Batch paperBatch(const std::string& world) {
  Request request;
  request.world = kWorlds + world;
  request.rules = {"off", "single", "collective", kOmniscient};
  request.repetitions = 2000;
  request.sets = 6;
  request.threads = 2;
  return runBatch(request, {});
}

}  // namespace

TEST_CASE("the symmetric calibration gives the paper's Table I, and the signs of Table II") {
  const Batch batch = paperBatch("transitions_symmetric.yaml");
  const std::optional<Agreement> agreement = agreementWithPaper(batch.tables);
  REQUIRE(agreement);
  const double position[] = {0.004, 0.004, 0.005, 0.002};
  const double orientation[] = {0.006, 0.008, 0.013, 0.003};
  for (size_t column = 0; column < 4; ++column) {
    INFO("column " << column);
    CHECK(agreement->position_rms[column] <= position[column]);
    CHECK(agreement->orientation_rms[column] <= orientation[column]);
  }
  CHECK(agreement->cells == 12);
  CHECK(agreement->orientation_signs == 12);
  CHECK(agreement->position_signs >= 8);
}

TEST_CASE("the asymmetric calibration gives the signs of Table II") {
  const Batch batch = paperBatch("transitions_asymmetric.yaml");
  const std::optional<Agreement> agreement = agreementWithPaper(batch.tables);
  REQUIRE(agreement);
  CHECK(agreement->orientation_signs >= 10);
  CHECK(agreement->position_signs >= 10);
}

TEST_CASE("the printed tables agree with each other but in the cells that are called doubtful") {
  REQUIRE(paperCells().size() == 24);
  for (const PaperCell& cell : paperCells()) {
    const double b = cell.errors[1], c = cell.errors[2];
    // The range of (b - c) / b due to rounding in the last place.
    const double low = 100.0 * (1.0 - (c + 0.0005) / (b - 0.0005)) - 0.9;
    const double high = 100.0 * (1.0 - (c - 0.0005) / (b + 0.0005)) + 0.1;
    const bool agrees = low <= cell.reduction && cell.reduction <= high;
    bool doubtful = !doubtOfReduction(cell).empty();
    for (size_t column = 0; column < 4; ++column)
      doubtful = doubtful || !doubtOfError(cell, column).empty();
    INFO(cell.from << " " << cell.to << " " << cell.quantity << ": " << low << " .. " << high);
    CHECK((agrees || doubtful));
  }
}

TEST_CASE("numbers of other surfaces are not compared with the paper") {
  const std::vector<TrialGround> grounds = groundsOfText(kSmallWorld);
  ExperimentSettings settings = smallSettings();
  settings.repetitions = 50;
  const Tables tables = tablesOf(runExperiment(grounds, settings, {}), settings, grounds);
  CHECK_FALSE(agreementWithPaper(tables));
  CHECK(textOfAgreement(tables, {{"ice", "road"}, settings.rules, true, 1}, {}).empty());
}

}  // namespace tread::experiment
