// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// After one pattern on slippery ground the learner corrects the other pattern, too.
#include <cstdio>

#include "modules/learner/core/learner.hpp"

using namespace tread;

std::vector<Pose2> arc(const Twist2& twist) {
  std::vector<Pose2> poses;
  for (int t = 1; t <= 40; ++t) poses.push_back(integrate(twist, 0.05 * t));
  return poses;
}

int main() {
  PatternSetContent content;
  content.name = "two patterns of 2 s";
  content.classes = {{"cruise", {1.0, 0.0, 0.0}, TrackCommand{1.0, 1.0}}};
  for (const auto& [id, name, command, twist] :
       {std::tuple{1, "straight", TrackCommand{1.0, 1.0}, Twist2{1.0, 0.0, 0.0}},
        std::tuple{2, "left", TrackCommand{0.7, 1.0}, Twist2{0.9, 0.0, 0.5}}})
    content.patterns.push_back({id, name, "cruise", "cruise", std::vector<Command>(40, command),
                                arc(twist), kUnknownCovariance, 0});
  std::string why;
  const auto shipped = PatternSet::make(std::move(content), why);
  if (!shipped) return std::fprintf(stderr, "%s\n", why.c_str()), 1;

  learner::Learner learner({}, *shipped);
  const auto say = [&](const char* when) {
    const Pose2 end = learner.set().find(2)->end();
    std::printf("%s: left ends at %.2f %.2f m, %.2f rad\n", when, end.x, end.y, end.yaw);
  };
  say("shipped");
  Measurement measured;
  measured.trajectory = arc({0.8, 0.0, 0.0});
  measured.covered = measured.trajectory.size();
  learner.learn(1, measured, learner::endError(measured, *shipped->find(1)), 2'000'000);
  say("learned");
}
