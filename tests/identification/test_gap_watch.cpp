// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "modules/identification/core/gap_watch.hpp"
#include "tests/identification/synthetic_drive.hpp"

namespace {

using namespace tread;
using namespace tread::gap;

ModelDocument watchedModel() {
  ModelDocument model;
  model.vehicle.name = "watched";
  model.vehicle.kind = CommandKind::kPower;
  model.vehicle.full_speed = 1.1;
  model.vehicle.lag = 0.15;
  model.vehicle.gauge = 0.6;
  return model;
}

/// The same drive with a left drive that gives less from a time on.
Drive withWeakLeft(const ModelDocument& model, double seconds, double from, double gain,
                   uint64_t seed) {
  Drive drive = syntheticDrive(model, seconds, seed);
  // What is commanded is more than what the vehicle that was simulated got.
  for (Segment& segment : drive.segments)
    for (CommandSample& sample : segment.commands)
      if (sample.time >= from) sample.command.left /= gain;
  return drive;
}

std::vector<NoticedGap> watchDrive(const Drive& drive, const ModelDocument& model, double seconds) {
  GapWatch watch;
  std::vector<NoticedGap> all;
  for (double t = 5.0; t + 5.0 <= seconds; t += 5.0) {
    Drive part = drive;
    Segment& segment = part.segments.front();
    const auto late = [&](double time) { return time < t - 10.0 || time > t + 6.5; };
    segment.commands.erase(std::remove_if(segment.commands.begin(), segment.commands.end(),
                                          [&](const CommandSample& s) { return late(s.time); }),
                           segment.commands.end());
    segment.ins.erase(std::remove_if(segment.ins.begin(), segment.ins.end(),
                                     [&](const InsSample& s) { return late(s.time); }),
                      segment.ins.end());
    segment.end = std::min(segment.end, t + 6.5);
    part.executions.clear();
    if (const auto reading = readChanges(part, model, t, t + 5.0)) {
      if (std::getenv("SHOW"))
        std::printf("%.0f %+.3f %+.3f %+.3f %+.3f  +- %.3f %.3f %.3f %.3f\n", t, reading->change[0],
                    reading->change[1], reading->change[2], reading->change[3],
                    reading->uncertainty[0], reading->uncertainty[1], reading->uncertainty[2],
                    reading->uncertainty[3]);
      if (const auto gap = watch.take(*reading)) all.push_back(*gap);
    }
  }
  return all;
}

TEST_CASE("a drive that gives less is noticed while it is driven") {
  const ModelDocument model = watchedModel();
  const Drive drive = withWeakLeft(model, 900.0, 300.0, 0.92, 5);
  for (const NoticedGap& gap : watchDrive(drive, model, 900.0))
    std::printf("part %d since %.0f noticed %.0f change %.3f +- %.3f\n", static_cast<int>(gap.part),
                gap.since, gap.noticed, gap.change, gap.uncertainty);
}

}  // namespace
