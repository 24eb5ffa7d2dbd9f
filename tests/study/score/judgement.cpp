// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/score/judgement.hpp"

#include <algorithm>
#include <cmath>

namespace tread::blindtest {
namespace {

constexpr double kGravity = 9.80665;  // [m/s^2]

struct Row {
  const char* effect;
  const char* symbol;
  SameQuantity same;
};

const Row kRows[] = {
    {"slip_ratio", "s", {"slip"}},
    {"track_asymmetry", "e", {"share"}},
    {"motor_deadband", "d", {"speed"}},
    {"speed_saturation", "u_max", {"limit", 1.0, true}},
    {"actuator_lag", "tau", {"lag"}},
    {"command_delay", "T_d", {"delay"}},
    {"slew_limit", "a_max", {"limit", 1.0, true}},
    {"lag_asymmetry", "d_tau", {"slowing"}},
    {"thermal_derating", "h", {"loss"}},
    {"track_backlash", "beta", {"slack"}},
    {"track_width", "k_t", {"widening"}},
    {"yaw_rate_skid", "k_2", {"skid"}},
    {"turn_power_limit", "omega_max", {"limit", 1.0, true}},
    {"yaw_breakaway", "omega_c", {"rate"}},
    {"speed_understeer", "K", {"gain"}},
    {"yaw_pull", "k", {"pull"}},
    {"grip_limit", "a_lat", {"friction", 1.0 / kGravity, true}},
    {"reverse_yaw_gain", "k", {"gain"}},
    {"yaw_inertia", "tau_w", {"lag"}},
    {"payload_change", "k", {"yaw"}},
    {"slope_pitch", "g_p", {"compliance"}},
    {"slope_roll", "g_r", {"compliance"}},
    {"centrifugal_drift", "k_c", {"time"}},
    {"rolling_resistance", "c", {"speed"}},
    {"quadratic_drag", "k", {"drag"}},
    {"turn_speed_loss", "k", {"loss"}},
    {"reverse_speed_gain", "k", {"gain"}},
    {"icr_offset", "x_icr", {"offset"}},
    {"body_inertia", "tau_v", {"lag"}},
    {"ins_latency", "L", {"latency"}},
    {"heading_latency", "T_h", {"latency"}},
    {"gyro_bias", "b", {"rate"}},
    {"heading_misalignment", "psi_0", {"angle"}},
    {"lever_arm_x", "l_x", {"offset"}},
    {"lever_arm_y", "l_y", {"offset"}},
    {"position_scale", "k", {"scale"}},
};

/// Effects that change the motion by less than this share of the noise do not count as excited.
constexpr double kLeastVisible = 0.05;
/// Smaller gaps relative to the floor cannot be closed.
constexpr double kLeastGap = 0.05;

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// Position and yaw in units of the truth's own error.
double inFloors(const EndError& error, const EndError& floor) {
  return std::hypot(error.position / floor.position, error.yaw / floor.yaw);
}

double closedShare(const EndError& error_before, const EndError& error_after,
                   const EndError& floor) {
  const double best = std::sqrt(2.0);
  const double before = inFloors(error_before, floor);
  const double after = inFloors(error_after, floor);
  if (!(before > best * (1.0 + kLeastGap)) || !std::isfinite(after)) return kUnknown;
  return (before - after) / (before - best);
}

/// Variables of the workflow that correspond to a word of the truth.
bool standsFor(const std::string& variable, const std::string& word) {
  const auto has = [&](const char* part) { return variable.find(part) != std::string::npos; };
  const bool turning = has("yaw rate");
  const bool speed = variable == "v" || variable == "|v|" || variable == "v^2" ||
                     variable == "v |v|" || variable == "sign of v";
  const bool before = has("command before");
  const bool command = (has("command") && !before && !has("since")) || has("the inner track");
  if (word == "speed" || word == "command") return speed || command || (turning && !has("change"));
  if (word == "acceleration" || word == "time_since_command" || word == "previous_command")
    return has("change of v") || has("change of |v|") || has("change of yaw rate") ||
           has("reversed") || has("set off") || before || has("since the command");
  if (word == "voltage") return has("elapsed") || has("voltage");
  if (word == "previous_turn") return turning || has("turns before");
  return false;
}

bool rightVariable(const CaseRecord& record) {
  for (const HiddenEffect& hidden : record.truth.effects)
    for (const std::string& word : hidden.depends_on)
      for (const auto& rest : record.answer.unexplained)
        if (standsFor(rest.second, word)) return true;
  return false;
}

/// Whether the verdict names something, including a changed term of the model.
bool namesSomething(const Answer& answer) {
  return contains({"FOUND", "AMBIGUOUS", "PARTIAL", "MEASUREMENT"}, answer.verdict);
}

bool isNamed(const std::string& name, const Answer& answer) {
  return std::any_of(answer.effects.begin(), answer.effects.end(),
                     [&](const NamedEffect& one) { return one.name == name; });
}

/// Whether an effect is listed as an alternative to a name.
bool isBeside(const NamedEffect& named, const HiddenEffect& hidden) {
  return contains(named.runner_ups, hidden.name) || contains(named.group, hidden.name);
}

void judgeNames(const CaseRecord& record, Judgement& judgement) {
  const std::vector<NamedEffect>& named = record.answer.effects;
  const auto right = [&](const NamedEffect& one, const HiddenEffect& hidden) {
    return belongs(one.name, hidden, record.answer) ||
           (record.truth.kind == "degenerate" && contains(record.truth.right_names, one.name));
  };
  bool all_listed = true;
  for (const HiddenEffect& hidden : record.truth.effects) {
    const auto is_right = [&](const NamedEffect& one) { return right(one, hidden); };
    const bool is_named = std::any_of(named.begin(), named.end(), is_right);
    const bool has_moved = !is_named && moved(record.answer, hidden);
    judgement.found += is_named || has_moved;
    judgement.moved += has_moved;
    all_listed =
        all_listed && (is_named || has_moved ||
                       std::any_of(named.begin(), named.end(),
                                   [&](const NamedEffect& one) { return isBeside(one, hidden); }));
    judgement.first_right =
        judgement.first_right || (named.empty() ? has_moved : is_right(named.front()));
  }
  const std::vector<HiddenEffect>& truth = record.truth.effects;
  const bool all_right = std::all_of(named.begin(), named.end(), [&](const NamedEffect& one) {
    return std::any_of(truth.begin(), truth.end(),
                       [&](const HiddenEffect& hidden) { return right(one, hidden); });
  });
  judgement.listed = !truth.empty() && all_listed;
  const bool said = !named.empty() || namesSomething(record.answer);
  judgement.alarm = said;
  judgement.nothing = !said && judgement.moved == 0;
  judgement.only_wrong = said && judgement.found == 0;
  judgement.exact = !truth.empty() && judgement.found == truth.size() && all_right;
}

/// A degenerate case is answered if its alternatives are named as such.
bool saysGroup(const CaseRecord& record) {
  const std::vector<std::string>& right = record.truth.right_names;
  for (const NamedEffect& named : record.answer.effects) {
    if (!contains(right, named.name)) continue;
    if (record.answer.verdict == "AMBIGUOUS") return true;
    for (const std::string& other : named.group)
      if (contains(right, other)) return true;
  }
  return false;
}

void judgeParameters(const CaseRecord& record, Judgement& judgement) {
  for (const HiddenEffect& hidden : record.truth.effects) {
    std::vector<Estimated> estimates = record.answer.calibrated;
    for (const NamedEffect& named : record.answer.effects)
      if (named.name == hidden.name)
        estimates.insert(estimates.end(), named.parameters.begin(), named.parameters.end());
    for (const HiddenNumber& number : hidden.numbers) {
      const auto same = sameQuantity(hidden.name, number.name, record.truth.duration);
      if (!same) continue;
      for (const Estimated& one : estimates) {
        if (one.path != hidden.name + "." + same->parameter || !std::isfinite(one.value)) continue;
        const double before = same->limit || !std::isfinite(one.before) ? 0.0 : one.before;
        const double change = number.value * same->factor;
        const double truth = before + change;
        judgement.parameters.push_back({one.path, hidden.shape,
                                        std::abs(one.value - truth) / std::abs(change),
                                        one.low <= truth && truth <= one.high});
      }
    }
  }
}

/// A hidden effect is named together with those that are indistinguishable from it.
bool isNamedInGroup(const CaseRecord& record) {
  const HiddenEffect& hidden = record.truth.effects.front();
  return std::any_of(
      record.answer.effects.begin(), record.answer.effects.end(), [&](const NamedEffect& one) {
        return !one.group.empty() && (covers(one.name, hidden) || isBeside(one, hidden));
      });
}

bool showsEnough(const Truth& truth) {
  if (truth.effects.empty() || !(truth.floor.position > 0.0)) return true;
  return truth.gap.position > kLeastVisible * truth.floor.position ||
         truth.gap.yaw > kLeastVisible * truth.floor.yaw ||
         truth.gap.yaw_rate > kLeastVisible * truth.floor.yaw_rate;
}

/// The effect that is equivalent to a number of the nominal model. Defined here again, because the
/// scoring must not use the workflow's code.
std::string effectOf(const std::string& path) {
  if (path == "delay") return "command_delay";
  if (path == "lag") return "actuator_lag";
  if (path == "forward_gain") return "slip_ratio";
  if (path == "yaw_gain") return "track_width";
  return path.substr(0, path.find('.'));
}

/// Whether a number has changed: according to the workflow, else by three sigma.
bool hasMoved(const Estimated& one) {
  if (one.moved) return *one.moved;
  constexpr double kSigmas = 3.0;
  constexpr double kIntervalSigmas = 2.0 * 1.96;
  if (!(std::abs(one.before) > 0.0)) return false;
  const double sigma = (one.high - one.low) / kIntervalSigmas;
  const double before = std::isfinite(one.before_sigma) ? one.before_sigma : 0.0;
  return std::abs(one.value - one.before) > kSigmas * std::hypot(sigma, before);
}

}  // namespace

bool covers(const std::string& name, const HiddenEffect& hidden) {
  return name == hidden.name || contains(hidden.group, name);
}

bool belongs(const std::string& name, const HiddenEffect& hidden, const Answer& answer) {
  if (covers(name, hidden)) return true;
  return std::any_of(hidden.together.begin(), hidden.together.end(), [&](const auto& all) {
    return contains(all, name) && std::all_of(all.begin(), all.end(), [&](const std::string& one) {
             return isNamed(one, answer);
           });
  });
}

bool moved(const Answer& answer, const HiddenEffect& hidden) {
  return std::any_of(answer.calibrated.begin(), answer.calibrated.end(), [&](const Estimated& one) {
    return covers(effectOf(one.path), hidden) && hasMoved(one);
  });
}

Judgement judge(const CaseRecord& record) {
  const Answer& answer = record.answer;
  Judgement judgement;
  judgement.right_verdict = contains(record.truth.right_verdicts, answer.verdict) ||
                            (!record.truth.effects.empty() &&
                             (record.truth.kind == "single" || record.truth.kind == "semi") &&
                             answer.verdict == "AMBIGUOUS" && isNamedInGroup(record));
  judgement.refused =
      (answer.verdict == "CANNOT_TELL" || answer.verdict == "error") && !answer.reason.empty();
  judgement.flagged = answer.verdict == "PARTIAL" || answer.verdict == "NOT_IN_CATALOGUE";
  judgement.grouped = saysGroup(record);
  judgement.right_variable = judgement.flagged && rightVariable(record);
  judgement.excited = showsEnough(record.truth);
  judgement.closed = closedShare(answer.before, answer.after, record.truth.floor);
  judgement.closed_median =
      closedShare(answer.before.median, answer.after.median, record.truth.floor.median);
  judgeNames(record, judgement);
  judgeParameters(record, judgement);
  return judgement;
}

std::optional<SameQuantity> sameQuantity(const std::string& effect, const std::string& symbol,
                                         double duration) {
  if (effect == "battery_sag" && symbol == "s" && duration > 0.0)
    return SameQuantity{"per_hour", 3600.0 / duration};
  for (const Row& row : kRows)
    if (effect == row.effect && symbol == row.symbol) return row.same;
  return std::nullopt;
}

}  // namespace tread::blindtest
