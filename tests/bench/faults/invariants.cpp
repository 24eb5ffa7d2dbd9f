// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/bench/faults/invariants.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string_view>

#include "common/messages/ins_messages.hpp"
#include "common/seal/seal.hpp"

namespace tread::faults {
namespace {

constexpr int64_t kToZero = 250'000;        // [us] from a cause until the motors are at zero
constexpr int64_t kWatchdog = 280'000;      // [us] the same if the controller has to detect it
constexpr int64_t kNoticed = 30'000;        // [us] shorter faults may fall between two steps
constexpr int64_t kProgramLease = 200'000;  // [us] at most
constexpr int64_t kInsSilence = 100'000;    // [us]
constexpr int64_t kInsAge = 300'000;        // [us]
constexpr float kRest = 0.05F;              // [1] of the largest command
constexpr int64_t kBump = 100'000;          // [us] a tilt may exceed its limit
constexpr int64_t kOneStep = 20'000;        // [us] step of the bridge, and its delays

std::string at(const Pose2& pose) {
  return std::to_string(pose.x) + ", " + std::to_string(pose.y);
}

}  // namespace

void MotorRule::receive(const Received& received) {
  const int64_t now = received.utime;
  if (const auto arm = messageOf(kArm, received)) {
    if (arm->armed != 0) arm_ = now;
    if (arm->armed == 0) needs_arm_ = now;
  } else if (const auto estop = messageOf(kEstop, received)) {
    estop_ = estop->engaged != 0;
    if (estop_) needs_arm_ = now;
  } else if (const auto notice = messageOf(kOperator, received)) {
    const bool possible = notice->seen_utime <= now + 100'000;
    if (notice->allowed == operator_t::ALLOW_DRIVING && possible)
      operator_seen_ = std::max(operator_seen_, notice->seen_utime);
  } else if (const auto program = messageOf(kProgram, received)) {
    if (program->utime > now + 50'000 || program->lease <= 0) return;
    const int64_t until = program->utime + std::min<int64_t>(program->lease, kProgramLease);
    program_until_ = std::max(program_until_, until);
    if (program->running.execution_id != 0) moving_until_ = std::max(moving_until_, until);
  } else if (const auto ins = messageOf(kIns, received)) {
    if (ins->utime <= ins_utime_ || ins->utime > now + 50'000) return;
    ins_utime_ = ins->utime;
    if (planarPose(*ins)) ins_received_ = now;
    receiveTilt(*ins, now);
  } else if (const auto manual = messageOf(kManual, received)) {
    receiveManual(*manual, received.changed, now);
  }
  // Both may arrive within one step of the bridge, in either order.
  if (present(now) && now - arm_ <= kOneStep) armed_ = std::max(armed_, arm_);
}

void MotorRule::receiveManual(const manual_t& message, bool changed, int64_t now) {
  const float left = std::abs(message.hand_left), right = std::abs(message.hand_right);
  const bool known = !std::isnan(left) && !std::isnan(right);
  const bool possible = !(left > 1.0F) && !(right > 1.0F) && message.seen_utime <= now + 100'000 &&
                        message.seen_utime >= now - limits_.hand_lease_us;
  Hand& hand = hands_[message.station];
  const bool moves = known && (left != 0.0F || right != 0.0F);
  const bool holds = message.hold != 0 && message.give_back == 0;
  if (now > hand.heard + limits_.hand_lease_us + kOneStep ||
      (!known && !changed && message.seq > hand.seq))
    hand.rested = false;
  hand.heard = now;
  if (possible && left <= kRest && right <= kRest) hand.rested = true;
  const bool may_move = holds && moves && hand.rested;
  const int64_t until = may_move ? message.seen_utime + limits_.hand_lease_us : now;
  // From outside it is unknown whether the bridge accepts a changed message: it may permit motion,
  // but does not end any.
  if (possible && changed && holds) hand.until = std::max(hand.until, until);
  if (!possible || changed || message.seq <= hand.seq) return;
  hand.seq = message.seq;
  hand.until = until;
  hand.holds = message.give_back == 0 && (hand.holds || holds);
}

void MotorRule::receiveTilt(const ins_t& message, int64_t now) {
  const auto& q = message.orientation;
  const YawPitchRoll attitude =
      yawPitchRoll(Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized());
  const bool known =
      (message.ins_status & ins_t::STATUS_NO_ATTITUDE) == 0 && message.utime >= now - kInsAge;
  const bool beyond =
      known && std::max(std::abs(attitude.roll), std::abs(attitude.pitch)) > limits_.tilt;
  if (!beyond) {
    tilt_since_.reset();
    tilts_ = 0;
    tilted_ = false;
    return;
  }
  tilt_since_ = tilt_since_.value_or(message.utime);
  const bool confirmed = ++tilts_ >= 3 && message.utime - *tilt_since_ >= kBump;
  if (confirmed && !tilted_) needs_arm_ = now;
  tilted_ = confirmed;
}

void MotorRule::start(int64_t now) {
  *this = MotorRule(limits_);
  needs_arm_ = now;
}

void MotorRule::end(int64_t /*now*/) {
  up_ = false;
}

bool MotorRule::present(int64_t now) const {
  return now <= operator_seen_ + limits_.operator_lease_us;
}

bool MotorRule::inHand() const {
  return std::any_of(hands_.begin(), hands_.end(),
                     [](const auto& hand) { return hand.second.holds; });
}

bool MotorRule::handMoves(int64_t now) const {
  return std::any_of(hands_.begin(), hands_.end(),
                     [&](const auto& hand) { return now <= hand.second.until; });
}

std::string MotorRule::programStopReason(int64_t now, bool faults) const {
  if (now > program_until_) return "no PROGRAM within its lease";
  if (now > ins_received_ + kInsSilence || now > ins_utime_ + kInsAge) return "no INS";
  if (faults) return "";
  if (tilted_) return "tilted beyond the limit";
  return now > moving_until_ ? "no PROGRAM wants motion" : "";
}

std::string MotorRule::stopReason(int64_t now, bool faults) const {
  if (!up_) return "the bridge is gone";
  if (estop_) return "the E-stop is engaged";
  if (!limits_.go_back && !present(now)) return "no operator within the lease";
  const std::string program = programStopReason(now, faults);
  if (faults) return inHand() ? "" : program;
  if (!program.empty() && !(present(now) && handMoves(now)))
    return inHand() ? "the hand holds no button, is silent, or was not seen at rest" : program;
  return armed_ > needs_arm_ ? "" : "not armed since the last stop";
}

std::string MotorRule::check(int64_t now, const std::array<double, 2>& power) {
  if (stopReason(now, true).empty())
    fault_since_.reset();
  else if (!fault_since_)
    fault_since_ = now;
  if (fault_since_ && now - *fault_since_ > kNoticed) needs_arm_ = now;
  const std::string reason = stopReason(now, false);
  if (reason.empty()) {
    forbidden_since_.reset();
    return "";
  }
  if (!forbidden_since_) {
    // A tilt counts after 100 ms, which are part of the time to stop.
    forbidden_since_ = tilted_ ? now - kBump : now;
    why_ = reason;
  }
  const bool turning = std::abs(power[0]) > 1e-9 || std::abs(power[1]) > 1e-9;
  const int64_t since = now - *forbidden_since_;
  if (!turning || since <= (up_ ? kToZero : kWatchdog)) return "";
  return "motors at " + std::to_string(power[0]) + ", " + std::to_string(power[1]) + " for " +
         std::to_string(since / 1000) + " ms after: " + why_ +
         (reason == why_ ? "" : ", then: " + reason);
}

void PathRule::start() {
  tiles_.clear();
  by_version_.clear();
  judged_at_.clear();
  sets_ = PatternSetAssembler();
  cell_ = 0.0;
}

void PathRule::receive(const Received& received) {
  if (const auto tile = messageOf(kMap, received)) {
    take(received.utime, *tile);
  } else if (const auto ins = messageOf(kIns, received)) {
    if (const auto pose = planarPose(*ins)) standOn(*pose);
  } else if (const auto part = messageOf(kPatternSet, received)) {
    if (auto set = sets_.add(*part)) by_version_.emplace(set->version(), *set);
  }
}

void PathRule::take(int64_t now, const map_tile_t& tile) {
  const int side = tile.tile_cells;
  const bool possible = tile.utime > 0 && tile.utime <= now + 100'000 && side > 0 &&
                        tile.num_cells == side * side && tile.cell_size > 0.0;
  if (!possible) return;
  // A map of another size is refused while the present one is alive, and replaces it later.
  const bool other = side != side_ || tile.cell_size != cell_;
  if (other && cell_ != 0.0 && now - taken_ < kForgotten) return;
  if (other) tiles_.clear();
  taken_ = now;
  cell_ = tile.cell_size;
  side_ = side;
  KnownTile& known = tiles_[{tile.tile_x, tile.tile_y}];
  if (tile.utime < known.utime) return;
  if (known.cells.empty()) {
    known.cells.assign(tile.cells.size(), kUnknown);
    known.since.assign(tile.cells.size(), 0);
  }
  known.utime = tile.utime;
  for (size_t i = 0; i < tile.cells.size(); ++i) {
    if (tile.cells[i] == kUnknown) continue;
    if (isFree(tile.cells[i]) != isFree(known.cells[i]) || known.cells[i] == kUnknown)
      known.since[i] = now;
    known.cells[i] = tile.cells[i];
  }
}

/// Unknown cells are accepted where the vehicle stands.
void PathRule::standOn(const Pose2& T_map_body) {
  if (cell_ == 0.0) return;
  const Grid lattice(cell_, {}, 0, 0);
  for (const CellIndex& cell : bare_.cells(lattice, T_map_body)) {
    const auto found = tiles_.find({floorDivide(cell.x, side_), floorDivide(cell.y, side_)});
    if (found == tiles_.end()) continue;
    const int x = cell.x - found->first.first * side_, y = cell.y - found->first.second * side_;
    Cell& known = found->second.cells[static_cast<size_t>(y * side_ + x)];
    if (known == kUnknown) known = kFree;
  }
}

PathRule::Blocked PathRule::under(const Footprint& footprint, const Pose2& T_map_body,
                                  int64_t before) const {
  Blocked blocked;
  for (const CellIndex& cell : footprint.cells(Grid(cell_, {}, 0, 0), T_map_body)) {
    const auto found = tiles_.find({floorDivide(cell.x, side_), floorDivide(cell.y, side_)});
    if (found == tiles_.end()) {
      ++blocked.all;
      continue;
    }
    const int x = cell.x - found->first.first * side_, y = cell.y - found->first.second * side_;
    const auto i = static_cast<size_t>(y * side_ + x);
    if (isFree(found->second.cells[i]) || found->second.since[i] > before) continue;
    ++blocked.all;
    if (found->second.cells[i] == kObstacle) ++blocked.obstacles;
  }
  return blocked;
}

std::string PathRule::check(int64_t now, const plan_t& plan) {
  std::string wrong;
  for (size_t i = 0; i < plan.execution_id.size() && wrong.empty(); ++i)
    if (plan.execution_id[i] != 0) wrong = checkStep(now, plan, i);
  return wrong;
}

std::string PathRule::checkStep(int64_t now, const plan_t& plan, size_t i) {
  const int64_t id = plan.execution_id[i];
  const std::pair<double, double> end{plan.pose[i][0], plan.pose[i][1]};
  const bool running = i == 0 && judged_at_.count(id) > 0;
  if (cell_ == 0.0 || running || judged_at_[id] == end) return "";
  judged_at_[id] = end;
  // A pattern from an older set is predicted again with the present one.
  const auto set = by_version_.find(plan.set_version);
  const MotionPattern* pattern =
      set == by_version_.end() ? nullptr : set->second.find(plan.pattern_id[i]);
  if (pattern == nullptr) return "";
  ++judged_;
  const Pose2 T_map_end{plan.pose[i][0], plan.pose[i][1], plan.pose[i][2]};
  const Pose2 T_map_start = T_map_end * inverse(pattern->end());
  Blocked at_start = under(wide_, T_map_start, INT64_MAX);
  // When it leaves a blocked place, poses are checked at intervals: allow one more cell.
  if (at_start.obstacles > 0) ++at_start.obstacles;
  if (at_start.all > 0) ++at_start.all;
  for (const Pose2& pose : pattern->trajectory) {
    const Blocked here = under(footprint_, T_map_start * pose, now - kDelay);
    if (here.obstacles <= at_start.obstacles && here.all <= at_start.all) continue;
    return "execution " + std::to_string(id) + " (" + pattern->name + ") from " + at(T_map_start) +
           " meets " + std::to_string(here.obstacles) + " obstacle cells and " +
           std::to_string(here.all - here.obstacles) + " unknown ones at " +
           at(T_map_start * pose) + "; at its start " + std::to_string(at_start.obstacles) +
           " and " + std::to_string(at_start.all - at_start.obstacles);
  }
  return "";
}

namespace {

template <class Message>
bool isStopOn(const Channel<Message>& channel, const Received& received) {
  const auto message = messageOf(channel, received);
  return message && stops(*message);
}

bool isStop(const std::string& channel, const std::vector<uint8_t>& bytes) {
  const auto size = static_cast<std::ptrdiff_t>(sizeWithoutSeal(bytes.data(), bytes.size()));
  const Received received{0, channel, {bytes.begin(), bytes.begin() + size}};
  return isStopOn(kArm, received) || isStopOn(kEstop, received) || isStopOn(kGoal, received) ||
         isStopOn(kFence, received);
}

constexpr std::ptrdiff_t kFingerprint = 8;  // [bytes] in front of each message

}  // namespace

void CountRule::sent(const std::string& channel, const std::vector<uint8_t>& bytes) {
  if (bytes.size() >= kFingerprint)
    types_.try_emplace(channel, bytes.begin(), bytes.begin() + kFingerprint);
}

void CountRule::receive(const std::string& name, const std::string& channel,
                        const std::vector<uint8_t>& bytes) {
  Node& node = nodes_[name];
  if (isStop(channel, bytes)) return;
  const std::string_view view(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const bool again = !node.seen.insert({channel, std::hash<std::string_view>()(view)}).second;
  const bool sealed = sizeWithoutSeal(bytes.data(), bytes.size()) != bytes.size();
  const auto type = types_.find(channel);
  const bool foreign = type != types_.end() && bytes.size() >= kFingerprint &&
                       !std::equal(type->second.begin(), type->second.end(), bytes.begin());
  if (foreign || (keyed_ && (!sealed || again))) ++node.bad;
}

std::string CountRule::check(const health_t& health) {
  Node& node = nodes_[health.process];
  int64_t told = health.undecodable;
  for (const counter_t& counter : health.counters)
    if (counter.counter_name.rfind("refused: ", 0) == 0) told += counter.counted;
  const int64_t expected = node.bad_before;
  node.bad_before = node.bad;
  if (told >= expected) return "";
  return health.process + " was handed " + std::to_string(expected) +
         " messages that it must refuse, HEALTH tells of " + std::to_string(told);
}

}  // namespace tread::faults
