// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/execution/supervisor.hpp"

#include <cmath>
#include <limits>

namespace tread::planner {
namespace {

/// After so many patterns in a row a recovery has helped.
constexpr int kRecovered = 6;
/// How far down the way to the goal the narrowest place is looked for [m].
constexpr double kDetourLook = 3.0;
constexpr double kDetourStep = 0.2;
/// A way that was given up is mentioned for so long [us].
constexpr int64_t kNoteTime = 5'000'000;
/// Nearer than this to the vehicle nothing is made a detour [m].
constexpr double kDetourNear = 0.8;

}  // namespace

Supervisor::Supervisor(const PlannerConfig& config, int64_t run_id)
    : config_(config),
      local_map_(config.local_map),
      search_(config.search),
      branch_search_(config.search),
      hysteresis_(config.side_hysteresis),
      tracker_(run_id),
      progress_(config.policy.patience) {}

bool Supervisor::takeSet(const PatternSet& set) {
  waiting_table_ = std::make_shared<const PatternTable>(set, config_.sweep, config_.default_sigma);
  return takeWaitingSet();
}

bool Supervisor::takeWaitingSet() {
  set_refusal_ = tracker_.conflictWith(waiting_table_->set());
  // Such a set would stop the vehicle, and what runs could not be told from it.
  const std::string defect = waiting_table_->defect();
  if (set_refusal_.empty() && !tracker_.running().empty() && !defect.empty())
    set_refusal_ = "PATTERN_SET version " + std::to_string(waiting_table_->set().version()) +
                   " waits: " + defect;
  if (!set_refusal_.empty()) return false;
  table_ = std::move(waiting_table_);
  ++counters_["sets taken"];
  cycles_with_old_set_ = 0;
  // The rest of the plan was predicted with the old one.
  last_plan_ = 0;
  planned_on_.reset();
  return true;
}

void Supervisor::followSet() {
  if (waiting_table_) takeWaitingSet();
  if (searched_table_ != table_ && mode_ == Mode::kDriving) ++cycles_with_old_set_;
}

Decision Supervisor::step(const PlannerInputs& s, const StopPredicate& stop) {
  stop_ = stop;
  planned_ = false;
  prediction_.reset();
  if (s.pose) {
    standstill_.take(*s.pose);
    track_.push(s.pose->utime, s.pose->T_map_body);
  }
  noteGoal(s);
  followBridge(s);
  followSet();
  was_armed_ = was_armed_ || (s.bridge && s.bridge->armed());
  const MapAndSet supplies{local_map_.newestUtime(),
                           table_ ? table_->defect() : "no PATTERN_SET yet", was_armed_};
  act(s, checkPreconditions(s, supplies, config_.ages));
  Decision decision;
  decision.planned = planned_;
  decision.report = report(s);
  return decision;
}

void Supervisor::act(const PlannerInputs& s, const Preconditions& ready) {
  if (ready.level == Preconditions::Level::kStop) {
    if (mode_ == Mode::kDriving) halt(s, ready.reason);
    nothing_since_.reset();
    progress_.restart(s.now);
    if (!s.goal && ready.status == PlanStatus::kWaiting) return say(PlanStatus::kIdle, "");
    return say(ready.status, ready.reason);
  }
  local_map_.updateSurroundings(s.pose->T_map_body, s.now);
  if (s.goal) local_map_.updateDistance(s.pose->T_map_body, *s.goal, s.now);
  if (s.goal && ready.level == Preconditions::Level::kGo && !arrived_) watchProgress(s);
  if (mode_ == Mode::kSettling) settle(s);
  if (mode_ == Mode::kDriving) drive(s, ready);
  if (mode_ == Mode::kStanding) stand(s, ready);
}

void Supervisor::noteGoal(const PlannerInputs& s) {
  std::optional<int64_t> id;
  if (s.goal) id = s.goal->id;
  if (id == goal_id_) return;
  goal_id_ = id;
  arrived_ = false;
  nothing_since_.reset();
  recovery_.restart();
  hysteresis_.forget();
  local_map_.forgetDetours();
  progress_.restart(s.now);
  note_until_ = 0;
  last_plan_ = 0;
  planned_ = true;
}

void Supervisor::followBridge(const PlannerInputs& s) {
  const bool led_to_rest = !tracker_.running().empty() && leadsToRest(tracker_.running());
  switch (tracker_.follow(s)) {
    case ExecutionTracker::Event::kNone:
      return;
    case ExecutionTracker::Event::kSwitched: {
      planned_on_.reset();
      const bool as_planned =
          !plan_.empty() && plan_.front().pattern_id == tracker_.running().pattern_id;
      if (as_planned)
        plan_.erase(plan_.begin());
      else
        plan_.clear();
      hysteresis_.begun(tracker_.running().pattern_id);
      last_plan_ = 0;
      if (++switches_ >= kRecovered) recovery_.restart();
      ++counters_["patterns joined"];
      return;
    }
    case ExecutionTracker::Event::kEnded:
      ++counters_["came to rest"];
      if (!led_to_rest) say(PlanStatus::kWaiting, "stopped: nothing was handed over in time");
      break;
    case ExecutionTracker::Event::kAborted:
      ++counters_["aborted by the bridge"];
      say(PlanStatus::kWaiting, "stopped by motor_bridge: " + tracker_.abortReason());
      break;
    case ExecutionTracker::Event::kNeverStarted:
      ++counters_["not begun by the bridge"];
      say(PlanStatus::kWaiting, "stopped: " + tracker_.abortReason());
      break;
  }
  mode_ = Mode::kSettling;
  settling_since_ = s.now;
  plan_.clear();
  planned_on_.reset();
}

void Supervisor::halt(const PlannerInputs& s, const std::string& why) {
  tracker_.stop();
  plan_.clear();
  mode_ = Mode::kSettling;
  settling_since_ = s.now;
  planned_ = true;
  ++counters_["stopped at once"];
  say(PlanStatus::kBlocked, "stopped at once: " + why);
}

void Supervisor::settle(const PlannerInputs& s) {
  const bool too_long = s.now - settling_since_ > config_.policy.settle_limit;
  if (!standstill_.stands(settling_since_) && !too_long) return;
  mode_ = Mode::kStanding;
  last_plan_ = 0;
}

bool Supervisor::sayUnreachable() {
  if (!local_map_.distanceToGoal().unreachable()) return false;
  time_to_go_ = std::numeric_limits<double>::quiet_NaN();
  say(PlanStatus::kUnreachable, local_map_.distanceToGoal().problem());
  return true;
}

void Supervisor::watchProgress(const PlannerInputs& s) {
  const double way = local_map_.distanceToGoal().length(s.pose->T_map_body.position());
  if (!std::isfinite(way) || !progress_.stuck(way, s.now)) return;
  ++counters_["no progress: a way given up"];
  note_ = "no progress for " + std::to_string(config_.policy.patience / 1'000'000) +
          " s: looking for another way";
  note_until_ = s.now + kNoteTime;
  addDetour(s);
}

void Supervisor::addDetour(const PlannerInputs& s) {
  if (static_cast<int>(local_map_.detours()) >= config_.policy.detours) {
    local_map_.forgetDetours();
    return;
  }
  const Eigen::Vector2d p = s.pose->T_map_body.position();
  std::optional<Eigen::Vector2d> narrowest;
  double least = std::numeric_limits<double>::infinity();
  const int points = static_cast<int>(kDetourLook / kDetourStep);
  for (const Eigen::Vector2d& at : local_map_.distanceToGoal().descend(p, kDetourStep, points)) {
    const double clearance = local_map_.collisionChecker().clearance(at);
    if ((at - p).norm() < kDetourNear || clearance >= least) continue;
    least = clearance;
    narrowest = at;
  }
  if (narrowest) local_map_.addDetour(*narrowest);
}

void Supervisor::sayDriving(const PlannerInputs& s) {
  const std::string& aim = local_map_.goalSubstitutionReason();
  say(PlanStatus::kDriving, s.now < note_until_ ? note_ : aim.empty() ? stopAhead() : aim);
}

bool Supervisor::leadsToRest(const ProgramSlot& slot) const {
  return slot.pattern().exit_class == table_->motionClass(table_->restClass()).name;
}

std::string Supervisor::stopAhead() const {
  size_t after = 0;  // index in the plan of what begins when the vehicle stands
  if (!leadsToRest(tracker_.running())) {
    if (plan_.empty() || plan_.front().exit_class != table_->restClass()) return {};
    after = 1;
  }
  if (after >= plan_.size())
    return plan_end_ == SearchEnd::kGoal ? "stopping at the goal" : "stopping: the plan ends there";
  const TablePattern& next = *table_->find(plan_[after].pattern_id);
  if (next.reverses) return "stopping to back up";
  const Pose2& end = next.end().pose;
  if (std::abs(end.yaw) > std::hypot(end.x, end.y)) return "stopping to turn on the spot";
  return next.exit == table_->restClass() ? "stopping for a small step"
                                          : "stopping to set off anew";
}

void Supervisor::say(PlanStatus status, const std::string& reason) {
  planned_ = planned_ || status != status_;
  status_ = status;
  reason_ = reason;
}

const TablePattern* Supervisor::runningPattern() const {
  if (tracker_.running().empty()) return nullptr;  // whose id 0 a set may have
  const TablePattern* newest = table_->find(tracker_.running().pattern_id);
  // The learner bends trajectories, never commands: another length is another pattern.
  const bool same = newest != nullptr && newest->pattern->commands.size() ==
                                             tracker_.running().pattern().commands.size();
  return same ? newest : nullptr;
}

PlanReport Supervisor::report(const PlannerInputs& s) const {
  PlanReport report;
  report.status = status_;
  report.reason = reason_;
  report.utime = s.pose ? s.pose->utime : 0;
  report.goal_id = s.goal ? s.goal->id : 0;
  report.set_version = table_ ? table_->set().version() : 0;
  report.time_to_go =
      mode_ == Mode::kDriving ? time_to_go_ : std::numeric_limits<double>::quiet_NaN();
  report.expansions = planned_ ? expansions_ : 0;
  double time = 0.0;
  if (!tracker_.running().empty() && prediction_) {
    time = prediction_->time_left;
    report.execution_ids.push_back(tracker_.running().execution_id);
    report.steps.push_back(
        {tracker_.running().pattern_id, prediction_->T_map_end, 0, time, prediction_->uncertainty});
  }
  for (size_t i = 0; i < plan_.size(); ++i) {
    const bool handed_over = i == 0 && plan_[i].pattern_id == tracker_.next().pattern_id;
    report.execution_ids.push_back(handed_over ? tracker_.next().execution_id : 0);
    report.steps.push_back(plan_[i]);
    report.steps.back().time += time;
  }
  return report;
}

}  // namespace tread::planner
