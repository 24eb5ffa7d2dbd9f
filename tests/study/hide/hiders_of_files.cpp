// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Effects from files (common/vehicle/README.md): their formulas, applied to the ground truth's
// motion. The formulas are parsed and computed independently, as generator and search share no
// code.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <stdexcept>

#include <muParser.h>

#include "common/config/config_reader.hpp"
#include "tests/study/hide/effect_list.hpp"
#include "tests/study/hide/test_field.hpp"

namespace tread::blind {
namespace {

constexpr double kFresh = 0.4;       // [s] time constant for changes of the motion
constexpr double kTurned = 0.8;      // [rad] of turning after which earlier turns are forgotten
constexpr double kMovesFrom = 0.05;  // [m/s]
constexpr double kSharpness = 20.0;  // [s/m or s/rad] of the sign of a motion
constexpr Range kAny{-1e6, 1e6};

double limited(double value, double inverse_limit, double beyond) {
  const double over = std::abs(value) * inverse_limit - 1.0;
  return over <= 0.0 ? value : std::copysign((1.0 + beyond * over) / inverse_limit, value);
}
double deadZone(double value, double width) {
  return std::copysign(std::max(0.0, std::abs(value) - width), value);
}
double lessened(double value, double loss) {
  return value / std::max(0.1, 1.0 + loss);
}
double smoothSign(double value) {
  return std::tanh(kSharpness * value);
}
double curve(const double* p, int count) {
  if (p[0] <= p[1]) return p[2];
  for (int i = 1; i + 3 < count; i += 2)
    if (p[0] <= p[i + 2])
      return p[i + 1] + (p[i + 3] - p[i + 1]) * (p[0] - p[i]) / (p[i + 2] - p[i]);
  return p[count - 1];
}

/// Numbers by name; formulas store references to them.
using Numbers = std::map<std::string, double>;

/// The properties of a parameter that hiding needs.
struct FileParameter {
  std::string name;
  std::string unit;
  std::string limit;  ///< for which it is the reciprocal
  std::string limit_unit;
  bool is_shape = false;
  double min = 0.0;
  double max = 0.0;
  double typical = 0.0;
};

/// The properties of an effect's file that hiding needs.
struct FileEffect {
  std::string name;
  std::string changes;
  std::string to;
  std::string follows;
  std::string over;
  std::vector<FileParameter> parameters;
  std::vector<std::string> group;
};

FileEffect readFile(const std::string& path) {
  ConfigReader reader = ConfigReader::fromFile(path);
  FileEffect effect;
  reader.text("name", effect.name, true);
  reader.choice("changes", effect.changes, {"track", "yaw_rate", "v", "v_y"}, true);
  reader.text("to", effect.to, true);
  reader.text("memory_follows", effect.follows);
  reader.text("memory_over", effect.over);
  for (ConfigReader& one : reader.sections("parameters", true)) {
    FileParameter& parameter = effect.parameters.emplace_back();
    std::string role = "strength";
    one.text("name", parameter.name, true);
    one.text("unit", parameter.unit, true);
    one.choice("role", role, {"strength", "shape"});
    parameter.is_shape = role == "shape";
    one.number("min", parameter.min, kAny, "", true);
    one.number("max", parameter.max, kAny, "", true);
    one.number("typical", parameter.typical, kAny, "", true);
    one.text("reciprocal_of", parameter.limit);
    one.text("reciprocal_unit", parameter.limit_unit);
  }
  for (ConfigReader& one : reader.sections("confused_with")) {
    bool always = false;
    one.flag("always", always);
    std::vector<std::string> members;
    one.texts("effects", members);
    if (always) effect.group.insert(effect.group.end(), members.begin(), members.end());
  }
  return effect;
}

/// The formulas of an effect and their numbers.
class Law {
 public:
  Law(const FileEffect& effect, Numbers numbers) : numbers_(std::move(numbers)) {
    numbers_["memory"] = 0.0;
    numbers_["gauge"] = plainVehicle().gauge;
    numbers_["battery_drop"] = 0.0;
    compile(effect.to, to_);
    if (effect.follows.empty()) return;
    compile(effect.follows, follows_);
    compile(effect.over, over_);
    remembers_ = true;
  }
  Law(const Law&) = delete;
  Law& operator=(const Law&) = delete;

  double& operator[](const char* name) { return numbers_.at(name); }

  /// New value of `value`; `memory` belongs to one track or to the motion.
  double changed(double value, double dt, double& memory) {
    numbers_["memory"] = memory;
    if (remembers_) {
      const double over = over_.Eval();
      const double target = follows_.Eval();
      memory += (target - memory) * (over > dt ? dt / over : 1.0);
      numbers_["memory"] = memory;
    }
    const double to = to_.Eval();
    return std::isfinite(to) ? to : value;
  }

 private:
  void compile(const std::string& text, mu::Parser& parser) {
    parser.DefineFun("limited", limited);
    parser.DefineFun("dead_zone", deadZone);
    parser.DefineFun("lessened", lessened);
    parser.DefineFun("smooth_sign", smoothSign);
    parser.DefineFun("curve", curve);
    for (auto& [name, value] : numbers_) parser.DefineVar(name, &value);
    try {
      parser.SetExpr(text);
      parser.Eval();
    } catch (const mu::ParserError& problem) {
      throw std::invalid_argument("'" + text + "': " + problem.GetMsg());
    }
  }

  Numbers numbers_;
  mu::Parser to_, follows_, over_;
  bool remembers_ = false;
};

void setTilt(Law& law, const Moment& now) {
  law["session_time"] = now.time;
  law["roll"] = now.roll;
  law["pitch"] = now.pitch;
}

Hider onTracks(const std::shared_ptr<Law>& law) {
  Hider hider;
  hider.drive = [law, left = 0.0, right = 0.0](const Moment& now,
                                               const sim::MotorPower& power) mutable {
    const double speed = plainVehicle().drive.free_speed;  // [m/s] per power
    setTilt(*law, now);
    const auto changed = [&](double own, double other, double side, double& memory) {
      (*law)["speed"] = speed * own;
      (*law)["other"] = speed * other;
      (*law)["side"] = side;
      return law->changed(speed * own, now.dt, memory) / speed;
    };
    return sim::MotorPower{changed(power.left, power.right, 1.0, left),
                           changed(power.right, power.left, -1.0, right)};
  };
  return hider;
}

/// Quantities of the motion that depend on the past.
struct LookingBack {
  Twist2 before;
  double turned = 0.0;
  double memory = 0.0;
};

void setMotion(Law& law, const Moment& now, const Twist2& v, LookingBack& back) {
  const double share = now.dt / kFresh;
  back.before.v_x += share * (v.v_x - back.before.v_x);
  back.before.omega += share * (v.omega - back.before.omega);
  back.turned += now.dt / kTurned * (v.omega - back.turned * std::abs(v.omega));
  const double speed = plainVehicle().drive.free_speed;
  setTilt(law, now);
  law["v"] = v.v_x;
  law["v_y"] = v.v_y;
  law["yaw_rate"] = v.omega;
  law["v_change"] = (v.v_x - back.before.v_x) / kFresh;
  law["yaw_rate_change"] = (v.omega - back.before.omega) / kFresh;
  law["turns_before"] = back.turned;
  law["forward_command"] = 0.5 * speed * (now.order.left + now.order.right);
  law["turning_command"] = 0.5 * speed * (now.order.right - now.order.left);
  law["left"] = now.belt_left;
  law["right"] = now.belt_right;
  law["moving"] =
      std::min(1.0, std::max(std::abs(now.belt_left), std::abs(now.belt_right)) / kMovesFrom);
}

Hider onMotion(const std::string& changes, const std::shared_ptr<Law>& law) {
  double Twist2::*const what = changes == "v"          ? &Twist2::v_x
                               : changes == "yaw_rate" ? &Twist2::omega
                                                       : &Twist2::v_y;
  Hider hider;
  hider.slide = [law, what, back = LookingBack{}](const Moment& now, Twist2 v) mutable {
    setMotion(*law, now, v, back);
    v.*what = law->changed(v.*what, now.dt, back.memory);
    return v;
  };
  return hider;
}

/// Size 2 is the typical value of one of the strengths, with random sign if allowed.
Hider hideByFormula(const FileEffect& effect, double size, Rng& rng) {
  std::vector<const FileParameter*> strengths;
  Numbers numbers;
  for (const FileParameter& parameter : effect.parameters) {
    if (!parameter.is_shape) strengths.push_back(&parameter);
    numbers[parameter.name] = parameter.is_shape ? parameter.typical : 0.0;
  }
  if (strengths.empty()) throw std::invalid_argument(effect.name + ": has no strength");
  const FileParameter& on =
      *strengths[static_cast<size_t>(rng.below(static_cast<int>(strengths.size())))];
  const double sign = on.min < 0.0 && on.max > 0.0 ? rng.sign() : 1.0;
  const double value = std::clamp(0.5 * size * on.typical * sign, on.min, on.max);
  numbers[on.name] = value;
  const bool track = effect.changes == "track";
  const auto quantities = track ? std::vector<const char*>{"speed", "other", "side"}
                                : std::vector<const char*>{"v",
                                                           "v_y",
                                                           "yaw_rate",
                                                           "v_change",
                                                           "yaw_rate_change",
                                                           "turns_before",
                                                           "forward_command",
                                                           "turning_command",
                                                           "left",
                                                           "right",
                                                           "moving"};
  for (const char* name : quantities) numbers[name] = 0.0;
  for (const char* name : {"session_time", "roll", "pitch"}) numbers[name] = 0.0;
  const auto law = std::make_shared<Law>(effect, std::move(numbers));
  Hider hider = track ? onTracks(law) : onMotion(effect.changes, law);
  hider.levers = {{on.name, value, on.unit}};
  hider.equivalent = {on.limit.empty() ? Quantity{on.name, value, on.unit}
                                       : Quantity{on.limit, 1.0 / value, on.limit_unit}};
  return hider;
}

}  // namespace

EffectSpec specOfFile(const std::string& path) {
  const FileEffect effect = readFile(path);
  EffectSpec spec;
  spec.name = effect.name;
  spec.kind = EffectKind::kAdded;
  spec.form = EffectForm::kKinematic;
  spec.shape = EffectShape::kSame;
  spec.make = [effect](double size, double, Rng& rng) { return hideByFormula(effect, size, rng); };
  spec.how = "the formula of its file";
  spec.group = effect.group;
  return spec;
}

}  // namespace tread::blind
