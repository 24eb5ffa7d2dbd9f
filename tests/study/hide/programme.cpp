// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/hide/programme.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "modules/simulator/core/noise.hpp"
#include "tests/study/hide/rng.hpp"

namespace tread::blind {
namespace {

using sim::MotorPower;

constexpr int64_t kMinuteUs = 60'000'000;
constexpr int64_t kStandUs = 25'000'000;
constexpr int64_t kRestUs = 16'000'000;
constexpr int64_t kBetweenRestsUs = 10 * kMinuteUs;
/// Largest half difference of power.
constexpr double kTurn = 0.55;

/// Rounded as in a hand-written pattern file.
MotorPower command(double mean, double half_difference) {
  const auto rounded = [](double power) {
    return std::round(std::clamp(power, -1.0, 1.0) * 1000.0) / 1000.0;
  };
  return {rounded(mean - half_difference), rounded(mean + half_difference)};
}

double eitherWay(Rng& rng) {
  return rng.uniform(0.0, 1.0) < 0.6 ? 1.0 : -1.0;
}

/// Any command: straight, on the spot, arcs, small differences at speed, weak ones, stops.
MotorPower anyCommand(Rng& rng, double vigour) {
  const double kind = rng.uniform(0.0, 1.0);
  if (kind < 0.22) return command(eitherWay(rng) * vigour * rng.uniform(0.15, 1.0), 0.0);
  if (kind < 0.40) return command(0.0, rng.sign() * vigour * rng.uniform(0.1, kTurn));
  if (kind < 0.72) {
    const double mean = eitherWay(rng) * vigour * rng.uniform(0.2, 0.9);
    return command(mean, rng.sign() * vigour * rng.uniform(0.05, kTurn));
  }
  if (kind < 0.86) {
    const double mean = eitherWay(rng) * vigour * rng.uniform(0.4, 1.0);
    return command(mean, rng.sign() * rng.uniform(0.01, 0.12));
  }
  if (kind < 0.94)
    return command(eitherWay(rng) * rng.uniform(0.02, 0.2), rng.sign() * rng.uniform(0.0, 0.1));
  return {};
}

MotorPower oneSpeedCommand(Rng& rng) {
  constexpr double kMean = 0.6;
  constexpr double kHalf = 0.25;
  const int kind = rng.below(10);
  if (kind == 0) return {};
  if (kind < 5) return command(kMean, 0.0);
  return command(kMean, rng.sign() * kHalf);
}

MotorPower straightCommand(Rng& rng) {
  return rng.below(4) == 0 ? MotorPower{} : command(0.6, 0.0);
}

MotorPower forwardOnly(const MotorPower& power) {
  const double mean = 0.5 * (power.left + power.right);
  const double half = 0.5 * (power.right - power.left);
  // Turns on the spot become forward arcs.
  const double forward = std::max(std::abs(mean), std::min(std::abs(half) + 0.05, 0.45));
  return command(forward, half);
}

class Composer {
 public:
  Composer(Choice choice, uint64_t seed) : choice_(choice), dice_(seed) {}

  MotorPower draw(size_t number) {
    constexpr size_t kPatternsPerVigour = 30;
    if (number % kPatternsPerVigour == 0) vigour_ = dice_.uniform(0.7, 1.0);
    switch (choice_) {
      case Choice::kFiveForward:
        return five_[static_cast<size_t>(dice_.below(5))];
      case Choice::kOneSpeed:
        return oneSpeedCommand(dice_);
      case Choice::kStraight:
        return straightCommand(dice_);
      case Choice::kForward:
        return forwardOnly(anyCommand(dice_, vigour_));
      case Choice::kFull:
        break;
    }
    return anyCommand(dice_, vigour_);
  }

 private:
  Choice choice_;
  Rng dice_;
  double vigour_ = 1.0;
  std::array<MotorPower, 5> five_{command(0.8, 0.0), command(0.7, 0.15), command(0.7, -0.15),
                                  command(0.5, 0.45), command(0.5, -0.45)};
};

}  // namespace

std::string choiceName(Choice choice) {
  switch (choice) {
    case Choice::kFiveForward:
      return "five_forward";
    case Choice::kForward:
      return "forward";
    case Choice::kOneSpeed:
      return "one_speed";
    case Choice::kStraight:
      return "straight";
    case Choice::kFull:
      break;
  }
  return "full";
}

std::optional<Choice> choiceNamed(const std::string& name) {
  for (const Choice choice : {Choice::kFull, Choice::kFiveForward, Choice::kForward,
                              Choice::kOneSpeed, Choice::kStraight})
    if (choiceName(choice) == name) return choice;
  return std::nullopt;
}

int Programme::at(int64_t time) const {
  const auto next = std::upper_bound(patterns.begin(), patterns.end(), time,
                                     [](int64_t t, const Pattern& p) { return t < p.start; });
  if (next == patterns.begin()) return -1;
  const auto found = std::prev(next);
  return time < found->start + kPatternUs ? static_cast<int>(found - patterns.begin()) : -1;
}

Programme makeProgramme(Choice choice, double minutes, uint64_t seed) {
  Composer composer(choice, sim::streamSeed(seed, kProgrammeStream));
  Programme programme;
  const auto wanted = static_cast<int64_t>(std::llround(minutes * 60e6 / kCommandUs)) * kCommandUs;
  const int64_t stand = std::min(kStandUs, wanted / 8 / kPatternUs * kPatternUs);
  // A rest in the middle of each ten minutes.
  const int64_t first_rest = std::min(kBetweenRestsUs, wanted) / 2;
  int64_t next_rest = wanted >= 2 * kMinuteUs ? first_rest : wanted;
  int64_t run = 1;
  std::map<std::pair<double, double>, int32_t> ids;
  int64_t time = stand;
  while (time + kPatternUs + stand <= wanted) {
    if (time >= next_rest) {
      time += kRestUs;
      next_rest += kBetweenRestsUs;
      ++run;
      continue;
    }
    const MotorPower power = composer.draw(programme.patterns.size());
    const auto id =
        ids.emplace(std::make_pair(power.left, power.right), static_cast<int32_t>(ids.size()) + 1);
    programme.patterns.push_back({time, run, id.first->second, power});
    time += kPatternUs;
  }
  programme.duration = time + stand;
  return programme;
}

}  // namespace tread::blind
