// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/recordings/local_motion.hpp"

#include "common/recordings/drive_recordings.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "common/recordings/csv_table.hpp"
#include "common/statistics/statistics.hpp"

namespace tread::recordings {
namespace {

constexpr double kLeastReach = 0.01;

void readPattern(ConfigReader& reader, PatternRecipe& recipe) {
  PatternWish wish;
  reader.text("name", wish.name, true);
  std::vector<double> command;
  reader.numbers("command", command, 2, {-20.0, 20.0}, "m/s, rad/s", true);
  wish.command = {command[0], command[1]};
  recipe.patterns.push_back(wish);
  if (!reader.has("mirror")) return;
  reader.text("mirror", wish.name);
  wish.command.w = -wish.command.w;
  recipe.patterns.push_back(wish);
}

/// Beyond the farthest neighbour, so that it has some weight, too.
constexpr double kBandwidth = 1.1;
/// Differences beyond this many robust standard deviations are no vehicle motion.
constexpr double kPlausible = 3.5;
/// Lower limits of the residual scales: m/s, m/s, rad/s and the same per second.
constexpr double kSmall[6] = {0.01, 0.01, 0.01, 0.01, 0.01, 0.01};

struct Neighbour {
  double distance;
  const SteadyWindow* window;
};

/// All windows, the nearest first; a tie is decided by session, step and window.
std::vector<Neighbour> byDistance(const std::vector<SteadyWindow>& windows,
                                  const BodyCommand& command, const BodyCommand& reach) {
  std::vector<Neighbour> sorted;
  sorted.reserve(windows.size());
  for (const SteadyWindow& window : windows)
    sorted.push_back({std::hypot((window.command.v - command.v) / reach.v,
                                 (window.command.w - command.w) / reach.w),
                      &window});
  std::sort(sorted.begin(), sorted.end(), [](const Neighbour& a, const Neighbour& b) {
    return std::tie(a.distance, a.window->session, a.window->step, a.window->window) <
           std::tie(b.distance, b.window->session, b.window->step, b.window->window);
  });
  return sorted;
}

TwistLine regressed(const std::vector<Neighbour>& neighbours, const BodyCommand& command,
                    const BodyCommand& reach) {
  const auto n = static_cast<Eigen::Index>(neighbours.size());
  const double bandwidth = kBandwidth * std::max(neighbours.back().distance, 1e-6);
  Eigen::MatrixXd A(n, 3);
  Eigen::MatrixXd targets(n, 6);
  Eigen::VectorXd prior(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Neighbour& near = neighbours[static_cast<size_t>(i)];
    A.row(i) << 1.0, (near.window->command.v - command.v) / reach.v,
        (near.window->command.w - command.w) / reach.w;
    targets.row(i) = near.window->profile.vector().transpose();
    prior[i] = std::pow(1.0 - std::pow(near.distance / bandwidth, 3), 3);
  }
  Eigen::Matrix<double, 6, 1> mean;
  for (Eigen::Index c = 0; c < 6; ++c)
    mean[c] = huberFit(A, targets.col(c), prior, {1, kSmall[c]})[0];
  return TwistLine::of(mean);
}

/// The other window of a step, or nullptr.
const SteadyWindow* partnerOf(const std::vector<SteadyWindow>& windows, const SteadyWindow& first) {
  for (const SteadyWindow& window : windows)
    if (window.session == first.session && window.step == first.step &&
        window.window > first.window)
      return &window;
  return nullptr;
}

using Vector6 = Eigen::Matrix<double, 6, 1>;

/// (c_1 - c_2) / sqrt(2) of each step with both windows, in the order of `sorted`.
std::vector<Vector6> differencesOf(const std::vector<SteadyWindow>& windows,
                                   const std::vector<Neighbour>& sorted) {
  std::vector<Vector6> differences;
  for (const Neighbour& near : sorted) {
    const SteadyWindow* partner = partnerOf(windows, *near.window);
    if (partner != nullptr)
      differences.push_back((near.window->profile.vector() - partner->profile.vector()) /
                            std::sqrt(2.0));
  }
  return differences;
}

/// Limit of a component's difference, from the `count` nearest steps.
Vector6 plausibleDifference(const std::vector<Vector6>& differences, size_t count) {
  Vector6 bound;
  count = std::min(count, differences.size());
  for (Eigen::Index c = 0; c < 6; ++c) {
    std::vector<double> sizes;
    for (size_t i = 0; i < count; ++i) sizes.push_back(std::abs(differences[i][c]));
    bound[c] = kPlausible * std::max(kSmall[c], kMadToSigma * medianOf(std::move(sizes), 0.0));
  }
  return bound;
}

void addDeviations(const std::vector<SteadyWindow>& windows, const std::vector<Neighbour>& sorted,
                   size_t wanted, LocalMotion& motion) {
  const std::vector<Vector6> differences = differencesOf(windows, sorted);
  const Vector6 bound = plausibleDifference(differences, 2 * wanted)
                            .cwiseMax(plausibleDifference(differences, differences.size()));
  for (const Vector6& difference : differences) {
    if (motion.deviations.size() == wanted) return;
    if ((difference.cwiseAbs() - bound).maxCoeff() > 0.0)
      ++motion.implausible;
    else
      motion.deviations.push_back(TwistLine::of(difference));
  }
}

/// A command larger than any driven one would be extrapolated.
void requireWithin(const std::vector<SteadyWindow>& windows, const BodyCommand& command) {
  BodyCommand driven;
  for (const SteadyWindow& window : windows) {
    driven.v = std::max(driven.v, std::abs(window.command.v));
    driven.w = std::max(driven.w, std::abs(window.command.w));
  }
  if (driven.v >= std::abs(command.v) && driven.w >= std::abs(command.w)) return;
  char text[200];
  std::snprintf(text, sizeof text,
                "its commands reach %.2f m/s and %.2f rad/s, a pattern has %.2f and %.2f", driven.v,
                driven.w, command.v, command.w);
  throw RecordingError(text);
}

}  // namespace

size_t PatternRecipe::samples() const {
  return static_cast<size_t>(std::llround(length / period));
}

BodyCommand PatternRecipe::reach() const {
  BodyCommand largest{kLeastReach, kLeastReach};
  for (const PatternWish& wish : patterns) {
    largest.v = std::max(largest.v, std::abs(wish.command.v));
    largest.w = std::max(largest.w, std::abs(wish.command.w));
  }
  return largest;
}

PatternRecipe defaultRecipe() {
  PatternRecipe recipe;
  recipe.patterns = {{"straight", {2.5, 0.0}},    {"left", {2.5, 1.5}},
                     {"right", {2.5, -1.5}},      {"hard_left", {1.8, 2.2}},
                     {"hard_right", {1.8, -2.2}}, {"spin_left", {0.0, 2.4}},
                     {"spin_right", {0.0, -2.4}}, {"reverse", {-2.5, 0.0}}};
  return recipe;
}

PatternRecipe readRecipe(ConfigReader reader) {
  PatternRecipe recipe;
  reader.text("name", recipe.name, true);
  int64_t neighbours = recipe.neighbours;
  int64_t deviations = recipe.deviations;
  reader.integer("neighbours", neighbours, {6, 1000}, "1");
  reader.integer("deviations", deviations, {10, 500}, "1");
  recipe.neighbours = static_cast<int>(neighbours);
  recipe.deviations = static_cast<int>(deviations);
  for (ConfigReader& pattern : reader.sections("patterns", true)) readPattern(pattern, recipe);
  reader.finish();
  if (recipe.patterns.empty()) throw reader.error("patterns", "none; at least one is needed");
  for (size_t i = 0; i < recipe.patterns.size(); ++i)
    for (size_t j = 0; j < i; ++j)
      if (recipe.patterns[i].name == recipe.patterns[j].name)
        throw reader.error("patterns",
                           "two are called '" + recipe.patterns[i].name + "'; names are unique");
  return recipe;
}

PatternRecipe scaledRecipe(PatternRecipe recipe, double v_factor, double w_factor) {
  for (PatternWish& wish : recipe.patterns) {
    wish.command.v *= v_factor;
    wish.command.w *= w_factor;
  }
  return recipe;
}

LocalMotion localMotion(const std::vector<SteadyWindow>& windows, const BodyCommand& command,
                        const PatternRecipe& recipe) {
  const auto needed = static_cast<size_t>(recipe.neighbours);
  if (windows.size() < needed)
    throw RecordingError("only " + std::to_string(windows.size()) + " steady windows; " +
                         std::to_string(needed) + " are needed around each pattern's command");
  requireWithin(windows, command);
  std::vector<Neighbour> sorted = byDistance(windows, command, recipe.reach());
  LocalMotion motion;
  addDeviations(windows, sorted, static_cast<size_t>(recipe.deviations), motion);
  if (motion.deviations.size() < static_cast<size_t>(recipe.deviations))
    throw RecordingError("only " + std::to_string(motion.deviations.size()) +
                         " steps with two steady windows that agree; " +
                         std::to_string(recipe.deviations) +
                         " are needed to tell how executions differ");
  sorted.resize(needed);
  motion.mean = regressed(sorted, command, recipe.reach());
  motion.reach = sorted.back().distance;
  motion.windows = needed;
  return motion;
}

std::vector<TwistLine> recordedProfiles(const LocalMotion& motion) {
  std::vector<TwistLine> profiles;
  const Eigen::Matrix<double, 6, 1> mean = motion.mean.vector();
  for (const TwistLine& deviation : motion.deviations) {
    profiles.push_back(TwistLine::of(mean + deviation.vector()));
    profiles.push_back(TwistLine::of(mean - deviation.vector()));
  }
  return profiles;
}

}  // namespace tread::recordings
