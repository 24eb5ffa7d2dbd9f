// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/experiment/first_executions.hpp"

#include <algorithm>

#include "tools/lab/experiment/end_region.hpp"
#include "tools/lab/experiment/trial_drive.hpp"

namespace tread::experiment {

void FirstExecutions::addRun(const FirstExecutions& run) {
  for (size_t k = 0; k < all_patterns.size(); ++k) all_patterns[k].addRun(run.all_patterns[k]);
  for (size_t j = 0; j < regions.size(); ++j)
    for (size_t i = 0; i < regions[j].size(); ++i) regions[j][i].add(run.regions[j][i]);
}

FirstExecutions driveFirstExecutions(Methods& methods, const TrialSite& site) {
  FirstExecutions result(methods.size());
  TrialDrive drive(methods, site);
  const auto testAll = [&](MethodErrors& errors) {
    drive.clear();
    for (size_t p = 0; p < site.to.tests.size(); ++p) drive.execute(p, false);
    drive.addTo(errors);
  };
  const auto execute = [&](size_t pattern, size_t j) {
    const auto count = [&](size_t i, double, double, const ExecutionEnd& end) {
      const auto covariance = methods.endCovariance(i, pattern);
      if (!covariance) return;
      const bool inside = isInside(methods.predictEnd(i, pattern), end.pose, *covariance);
      result.regions[j][i].add({1.0, inside ? 1.0 : 0.0});
    };
    if (j == 0)
      drive.executeFirst(pattern, true, count);
    else
      drive.execute(pattern, true, count);
  };
  for (int64_t repetition = 0; repetition < site.repetitions; ++repetition) {
    methods.reset();
    size_t tested = 0;
    for (size_t j = 0; j < FirstExecutions::kCount; ++j) {
      if (tested < FirstExecutions::kTested.size() && FirstExecutions::kTested[tested] == j)
        testAll(result.all_patterns[tested++]);
      execute(drive.any(), j);
    }
  }
  return result;
}

}  // namespace tread::experiment
