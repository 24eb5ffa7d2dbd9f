// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/patterns/core/pattern_candidates.hpp"

#include <algorithm>
#include <stdexcept>

#include "common/vehicle/kernel.hpp"
#include "tools/robot/patterns/recipe.hpp"

namespace tread::patterns {
namespace {

constexpr double kLags = 3.0;        // 95 % of a change of speed is over by then
constexpr double kHolds = 3.0;       // default duration of a pattern, in settling times
constexpr double kMostLonger = 2.0;  // [1] slow patterns last longer by at most this factor
constexpr double kBackwards = 0.4;   // of the full speed
constexpr double kAside = 0.5;       // of the full speed, to the side
constexpr double kStep = 0.4;        // of the full speed, from rest to rest
constexpr double kTurnShare = 0.35;  // of the drive's largest yaw rate
constexpr double kEasing = 0.05;     // step by which an infeasible turn is slowed down
// [1] classes of perpendicular directions are connected from this ratio of speeds on
constexpr double kLikeSpeeds = 0.6;
// [1] of the gap, sideways or in rad: smaller turns are not worth a pattern
constexpr double kLeastTurn = 0.075;
constexpr double kSame = 1e-9;
// Speeds as shares of the full speed, for few, more and many patterns.
const std::vector<std::vector<double>> kShares{{1.0}, {0.4, 1.0}, {0.2, 0.5, 1.0}};
const std::vector<double> kStrengths{0.1, 0.2, 0.35, 0.5, 0.75, 1.0};
const std::vector<double> kTimes{0.1, 0.15, 0.2, 0.3, 0.4, 0.55, 0.75, 1.0, 1.3, 1.6, 2.0};
const std::vector<std::string> kNames{"crawl", "slow", "fast"};
constexpr int kForThree = 30;  // patterns from which three speeds pay off,
constexpr int kForTwo = 20;    // and two

/// A positive number for people, with few digits.
std::string hundredths(double value) {
  const std::string digits = std::to_string(100 + std::lround(100.0 * value) % 100);
  return std::to_string(std::lround(100.0 * value) / 100) + "." + digits.substr(1);
}

double rounded(double value) {
  const double thousandths = std::round(1000.0 * value);
  return thousandths == 0.0 ? 0.0 : thousandths / 1000.0;
}

}  // namespace

CandidateFamily::CandidateFamily(const VehicleModel& model, const RecipeWish& wish)
    : model_(model), wish_(wish) {
  const auto whole = [&](double s) { return wish_.period * std::ceil(s / wish_.period - 1e-6); };
  const double lag = std::max(model_.settlingLag(), model_.isCar() ? model_.steering_lag : 0.0);
  hold_ = std::max(whole(kLags * lag + model_.commandDelay()), wish_.period);
  longest_ = wish_.seconds > 0.0 ? wish_.seconds : kHolds * hold_;
  if (longest_ < hold_ + 2.0 * wish_.period - kSame)
    throw std::runtime_error("patterns of " + hundredths(longest_) + " s are too short; " +
                             hundredths(hold_ + 2.0 * wish_.period) +
                             " s are needed by this robot, three lags and a turn");
  top_ = topSpeed();
  makeClasses();
  for (size_t entry = 0; entry < classes_.size(); ++entry)
    for (size_t exit = 0; exit < classes_.size(); ++exit)
      if (joined(entry, exit)) join(entry, exit);
}

double CandidateFamily::sideSpeed(double command, bool left) const {
  const TrackCommand speeds = steadyEntry(model_, {command, command}).track_speeds;
  return left ? speeds.left : speeds.right;
}

double CandidateFamily::sideCommand(double speed, bool left) const {
  if (speed == 0.0) return 0.0;
  double low = 0.0, high = wish_.max_command;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (std::abs(sideSpeed(std::copysign(middle, speed), left)) < std::abs(speed) ? low : high) =
        middle;
  }
  return rounded(std::copysign(high, speed));
}

std::vector<double> CandidateFamily::row(const Wanted& motion) const {
  if (model_.isOmni()) return {rounded(motion.forward), rounded(motion.left), rounded(motion.turn)};
  if (model_.isCar()) return {sideCommand(motion.forward, true), rounded(motion.turn)};
  const double aside = 0.5 * model_.gauge * motion.turn;
  return {sideCommand(motion.forward - aside, true), sideCommand(motion.forward + aside, false)};
}

bool CandidateFamily::drivable(const Wanted& motion) const {
  const double most = wish_.acceleration + kSame;
  if (model_.isOmni()) {
    if (motion.speed() * std::abs(motion.turn) > most) return false;
    const double unit = model_.kind == CommandKind::kTrackSpeed ? 1.0 : model_.full_speed;
    const Command rims = model_.wheels.speeds({motion.forward, motion.left, motion.turn});
    for (size_t i = 0; i < model_.wheels.size(); ++i)
      if (std::abs(rims[i]) > unit * wish_.max_command + kSame) return false;
    return true;
  }
  const double left = sideSpeed(wish_.max_command, true) + kSame;
  if (model_.isCar())
    return std::abs(motion.forward) <= left &&
           std::abs(motion.turn) <= wish_.max_steering + kSame &&
           motion.forward * motion.forward * std::tan(std::abs(motion.turn)) <=
               most * model_.wheelbase;
  const double aside = 0.5 * model_.gauge * motion.turn;
  return std::abs(motion.forward * motion.turn) <= most &&
         std::abs(motion.forward - aside) <= left &&
         std::abs(motion.forward + aside) <= sideSpeed(wish_.max_command, false) + kSame;
}

std::optional<Wanted> CandidateFamily::withinReach(const Wanted& motion) const {
  for (double share = 1.0; share > 0.5 * kEasing; share -= kEasing)
    if (drivable(motion.slower(share))) return motion.slower(share);
  return std::nullopt;
}

double CandidateFamily::topSpeed() const {
  if (!model_.isOmni())
    return std::min(sideSpeed(wish_.max_command, true),
                    sideSpeed(wish_.max_command, !model_.isCar() ? false : true));
  const Command rims = model_.wheels.speeds({1.0, 0.0, 0.0});
  double most = 0.0;
  for (size_t i = 0; i < model_.wheels.size(); ++i) most = std::max(most, std::abs(rims[i]));
  const double unit = model_.kind == CommandKind::kTrackSpeed ? 1.0 : model_.full_speed;
  return unit * wish_.max_command / most;
}

double CandidateFamily::hardestTurn() const {
  if (model_.isCar()) return wish_.max_steering;
  const double radius = model_.isOmni() ? model_.wheels.radius() : 0.5 * model_.gauge;
  return kTurnShare * topSpeed() / radius;
}

double CandidateFamily::longest(double speed) const {
  if (speed <= 0.0) return kMostLonger * longest_;
  return longest_ * std::clamp(std::sqrt(top_ / speed), 1.0, kMostLonger);
}

std::vector<double> CandidateFamily::chosenSpeeds() const {
  std::vector<double> speeds = wish_.speeds;
  std::sort(speeds.begin(), speeds.end());
  if (!speeds.empty() && speeds.back() > top_ + 1e-6)
    throw std::runtime_error("a speed of " + hundredths(speeds.back()) +
                             " m/s exceeds the robot's top speed, " + hundredths(top_) + " m/s");
  if (speeds.size() > kNames.size() + 1)
    throw std::runtime_error(std::to_string(speeds.size()) + " speeds; at most four are allowed");
  if (!speeds.empty()) return speeds;
  // From standstill through the longest pattern back to standstill.
  const double full = std::min(top_, wish_.room / (2.0 * hold_ + longest_));
  const size_t row = wish_.patterns >= kForThree ? 2 : wish_.patterns >= kForTwo ? 1 : 0;
  for (const double share : kShares[row]) speeds.push_back(share * full);
  return speeds;
}

void CandidateFamily::addClass(const std::string& name, const Wanted& motion, int level) {
  classes_.push_back({name, motion, level, row(motion)});
}

void CandidateFamily::makeClasses() {
  const std::vector<double> speeds = chosenSpeeds();
  top_ = speeds.back();
  addClass("rest", {}, 0);
  for (size_t i = 0; i < speeds.size(); ++i)
    addClass(i + 1 == speeds.size() ? "full" : kNames[speeds.size() == 2 ? 1 : i],
             {speeds[i], 0, 0}, static_cast<int>(i) + 1);
  const double back = kBackwards * top_;
  const bool creeps = wish_.patterns >= kForThree && speeds.front() < kLikeSpeeds * back;
  if (creeps) addClass("creep_back", {-speeds.front(), 0, 0}, 1);
  addClass("back", {-back, 0, 0}, creeps ? 2 : 1);
  if (!model_.isOmni()) return;
  const Wanted aside{0.0, kAside * top_, 0.0};
  if (!drivable(aside)) return;
  addClass("aside_left", aside, 1);
  addClass("aside_right", aside.mirrored(), 1);
}

size_t CandidateFamily::mirrorOf(size_t index) const {
  if (classes_[index].motion.left == 0.0) return index;
  return classes_[index].motion.left > 0.0 ? index + 1 : index - 1;
}

bool CandidateFamily::joined(size_t entry, size_t exit) const {
  // A mirror image is generated together with its original.
  const auto right = [&](size_t i) { return classes_[i].motion.left < 0.0; };
  if (right(entry) || (right(exit) && mirrorOf(entry) == entry)) return false;
  if (entry == exit) return true;
  const DesignedClass &a = classes_[entry], &b = classes_[exit];
  if (a.level == 0 || b.level == 0) return true;
  const double along = a.motion.forward * b.motion.forward + a.motion.left * b.motion.left;
  if (along > 0.0) return std::abs(a.level - b.level) == 1;
  const double slower = std::min(a.motion.speed(), b.motion.speed());
  return along == 0.0 && slower >= kLikeSpeeds * std::max(a.motion.speed(), b.motion.speed());
}

void CandidateFamily::join(size_t entry, size_t exit) {
  const Wanted from = classes_[entry].motion, to = classes_[exit].motion;
  if (entry == 0 && exit == 0) return addOnTheSpot();
  addStraight(entry, exit);
  const Wanted base = exit == 0 ? from.slower(0.5) : to;
  addTurns(entry, exit, base);
  if (exit != 0 && classes_[exit].motion.speed() == top_) addTurns(entry, exit, to.slower(0.6));
}

void CandidateFamily::addOnTheSpot() {
  const double step = kStep * top_;
  for (const double forward : {step, -step}) {
    addHeld(0, 0, {forward, 0, 0}, false);
    addTurns(0, 0, {forward, 0, 0});
  }
  if (model_.isCar()) return;
  addHeld(0, 0, {0, 0, hardestTurn()}, false);
  if (model_.isOmni()) addHeld(0, 0, {0, step, 0}, false);
}

void CandidateFamily::addStraight(size_t entry, size_t exit) {
  const Wanted to = classes_[exit].motion;
  if (entry != exit) return add(entry, exit, {});
  for (const double seconds : kTimes)
    if (hold_ + seconds <= longest(to.speed()) + kSame) add(entry, exit, {{to, seconds}});
  add(entry, exit, {});
}

void CandidateFamily::addTurns(size_t entry, size_t exit, const Wanted& base) {
  for (const double strength : kStrengths) {
    const std::optional<Wanted> turn =
        withinReach({base.forward, base.left, strength * hardestTurn()});
    if (!turn) continue;
    addHeld(entry, exit, *turn, false);
    if (entry == exit && entry != 0) addHeld(entry, exit, *turn, true);
    if (base.left != 0.0) addHeld(entry, exit, {turn->forward, turn->left, -turn->turn}, false);
  }
  if (!model_.isOmni() || base.left != 0.0) return;
  for (const double share : {0.25, 0.5}) {
    const std::optional<Wanted> aslant = withinReach({base.forward, share * base.forward, 0});
    if (aslant) addHeld(entry, exit, *aslant, false);
  }
}

void CandidateFamily::addHeld(size_t entry, size_t exit, const Wanted& motion, bool to_and_fro) {
  const double slower = std::min(classes_[entry].motion.speed(), classes_[exit].motion.speed());
  for (const double seconds : kTimes) {
    std::vector<Held> helds{{motion, seconds}};
    if (to_and_fro) helds.push_back({{motion.forward, motion.left, -motion.turn}, seconds});
    if (hold_ + seconds * static_cast<double>(helds.size()) > longest(slower) + kSame) break;
    add(entry, exit, helds);
  }
}

void CandidateFamily::add(size_t entry, size_t exit, std::vector<Held> helds) {
  const Wanted from = classes_[entry].motion, to = classes_[exit].motion;
  const auto change = [](const Wanted& a, const Wanted& b) {
    return std::hypot(a.forward - b.forward, a.left - b.left);
  };
  double held = 0.0;
  bool turns = false;
  for (const Held& one : helds) {
    held += one.seconds;
    turns = turns || one.motion.turn != 0.0;
  }
  const double last = helds.empty() ? 0.0 : change(helds.back().motion, to);
  const double needed =
      std::max({hold_, last / wish_.acceleration, change(from, to) / wish_.acceleration - held});
  helds.push_back({to, wish_.period * std::ceil(needed / wish_.period - 1e-6)});
  CandidatePair pair{made(entry, exit, helds)};
  const Pose2& end = pair.front().end;
  if (turns && std::hypot(end.y, wish_.gap * end.yaw) < kLeastTurn * wish_.gap) return;
  std::vector<Held> mirrored = helds;
  for (Held& one : mirrored) one.motion = one.motion.mirrored();
  CandidatePattern other = made(mirrorOf(entry), mirrorOf(exit), mirrored);
  if (other.rows != pair.front().rows || other.entry != entry) pair.push_back(std::move(other));
  pairs_.push_back(std::move(pair));
}

CandidatePattern CandidateFamily::made(size_t entry, size_t exit,
                                       const std::vector<Held>& helds) const {
  CandidatePattern candidate;
  candidate.entry = entry;
  candidate.exit = exit;
  std::vector<Command> commands;
  for (const Held& held : helds) {
    std::vector<double> line = row(held.motion);
    const auto samples = static_cast<size_t>(std::lround(held.seconds / wish_.period));
    commands.insert(commands.end(), samples, commandOf(model_, line));
    candidate.seconds += held.seconds;
    if (!candidate.rows.empty() &&
        std::equal(line.begin(), line.end(), candidate.rows.back().begin())) {
      candidate.rows.back().back() += held.seconds;
      continue;
    }
    line.push_back(held.seconds);
    candidate.rows.push_back(std::move(line));
  }
  const Command steady = commandOf(model_, classes_[entry].row);
  candidate.end = simulateFrom(model_, steady, commands, wish_.period).back();
  return candidate;
}

}  // namespace tread::patterns
