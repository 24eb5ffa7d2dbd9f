// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors

#include "tools/lab/gap/what_if.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/config/scalars.hpp"
#include "common/report/page.hpp"
#include "common/vehicle/model_file.hpp"
#include "modules/identification/core/end_errors.hpp"
#include "modules/identification/core/observations.hpp"
#include "tools/lab/gap/compare.hpp"
#include "tools/lab/gap/manoeuvres.hpp"
#include "tools/lab/gap/repeat.hpp"
#include "tools/lab/gap/report/find_output.hpp"
#include "tools/lab/gap/report/pictures.hpp"

namespace tread::gap {

using namespace report;

namespace {

/// Whether two names share a word of three or more letters, as slip and slip_ratio.
bool resemble(const std::string& name, const Effect& effect) {
  size_t begin = 0;
  while (begin < name.size()) {
    const size_t end = std::min(name.find_first_of("_- ", begin), name.size());
    const std::string word = name.substr(begin, end - begin);
    if (word.size() >= 3 && effect.name.find(word) != std::string::npos) return true;
    begin = end + 1;
  }
  return false;
}

/// An effect by name; otherwise an error that lists similar names.
const Effect& effectOrNear(const std::string& name) {
  std::vector<std::string> all;
  std::vector<std::string> near;
  for (const Effect& effect : effectCatalogue()) {
    if (effect.name == name) return effect;
    all.push_back(effect.name);
    if (resemble(name, effect)) near.push_back(effect.name);
  }
  const auto spelt = nearestSpelling(name, all);
  if (spelt && std::find(near.begin(), near.end(), *spelt) == near.end())
    near.insert(near.begin(), *spelt);
  if (near.empty()) return effectOrGuess(name);  // throws
  throw std::runtime_error("'" + name + "' is no effect of the catalogue; did you mean " +
                           joined(near, "or") + "?");
}

std::string parameterNames(const Effect& effect) {
  std::vector<std::string> names;
  for (const EffectParameter& parameter : effect.parameters) {
    names.push_back(parameter.name);
    if (parameter.reciprocal()) names.push_back(parameter.natural_name);
  }
  return joinWords(names);
}

/// Name by which people set the size of an effect.
std::string firstStrength(const Effect& effect) {
  const EffectParameter& first = effect.parameters.front();
  return first.reciprocal() ? first.natural_name : first.name;
}

void setEffect(ModelDocument& model, const Effect& effect, const std::string& name, double value) {
  for (const EffectParameter& parameter : effect.parameters) {
    const bool natural = parameter.reciprocal() && name == parameter.natural_name;
    if (!natural && name != parameter.name) continue;
    if (natural && value == 0.0)
      throw std::runtime_error(name + "=0: with a limit of 0 nothing can move");
    const double held = natural ? 1.0 / value : value;
    if (held < parameter.min || held > parameter.max)
      throw std::runtime_error(effect.name + "." + name + "=" + formatNumber(value) +
                               ": not plausible; " + parameter.name + " is " +
                               formatNumber(parameter.min) + " to " + formatNumber(parameter.max) +
                               (parameter.unit == "1" ? "" : " " + parameter.unit));
    valueOf(model, parameter) = held;
    return;
  }
  throw std::runtime_error("'" + name + "' is not a parameter of " + effect.name + "; it has " +
                           parameterNames(effect));
}

void set(ModelDocument& model, const std::string& assignment, const Effect* last_added) {
  const size_t equals = assignment.find('=');
  const auto value =
      equals == std::string::npos ? std::nullopt : parseNumber(assignment.substr(equals + 1));
  if (!value) throw std::runtime_error("--set " + assignment + ": write parameter=number");
  const std::string path = assignment.substr(0, equals);
  const size_t point = path.find('.');
  if (point != std::string::npos) {
    const Effect& effect = effectOrNear(path.substr(0, point));
    requireOf("--set", effect.name, model.vehicle.layout());
    setEffect(model, effect, path.substr(point + 1), *value);
  } else if (double* number = findParameter(model, path)) {
    if (!(*value >= 0.0))
      throw std::runtime_error("--set " + assignment + ": must not be negative");
    *number = *value;
  } else if (last_added != nullptr) {
    setEffect(model, *last_added, path, *value);
  } else {
    throw std::runtime_error("--set " + assignment +
                             ": no such parameter; write effect.parameter=number, or lag, delay, "
                             "forward_gain, yaw_gain, full_speed or gauge");
  }
}

constexpr size_t kShownExecutions = 9;
constexpr double kRounding = 1e-9;  // [m] and [rad]

std::vector<Pose2> posesOf(const std::vector<MotionSample>& motion) {
  std::vector<Pose2> poses;
  poses.reserve(motion.size());
  for (const MotionSample& moment : motion) poses.push_back(moment.T_map_body);
  return poses;
}

/// In millimetres below 10 cm, without fractions.
std::string shownDistance(double distance) {
  return std::abs(distance) < 0.1 ? formatted("%.0f mm", 1000.0 * distance)
                                  : formatted("%.2f m", distance);
}

/// Tenths of a degree, without -0.0.
std::string shownAngle(double angle) {
  const double tenths = std::round(10.0 * angle * 180.0 / kPi);
  return formatted("%.1f deg", tenths == 0.0 ? 0.0 : 0.1 * tenths);
}

std::string picture(const ManoeuvreComparison& comparison) {
  Chart chart(comparison.name, "to the right [m]", "ahead [m]",
              rangeOf({&comparison.first, &comparison.second}));
  drawPath(chart, comparison.first, kBeforeColour, true);
  drawPath(chart, comparison.second, kAfterColour, false);
  chart.legend("as it is", kBeforeColour, true);
  chart.legend("what if: " + shownDistance(comparison.position) + ", " +
                   shownAngle(comparison.yaw) + " apart",
               kAfterColour);
  return chart.svg();
}

std::vector<std::string> picturesOf(const std::vector<ManoeuvreComparison>& comparisons) {
  std::vector<std::string> pictures;
  pictures.reserve(comparisons.size());
  for (const ManoeuvreComparison& comparison : comparisons) pictures.push_back(picture(comparison));
  return pictures;
}

std::vector<std::string> picturesOf(const LogComparison& comparison) {
  std::vector<std::string> pictures;
  pictures.reserve(comparison.overlays.size());
  for (const Overlay& overlay : comparison.overlays)
    pictures.push_back(
        overlayPicture(overlay, "execution at " + threeDigits(overlay.begin) + " s"));
  return pictures;
}

double apart(const Overlay& overlay) {
  return (overlay.before.back().position() - overlay.after.back().position()).norm();
}

std::string row(const std::string& name, const std::string& position, const std::string& yaw) {
  return formatted("%-28s %14s %14s\n", name.c_str(), position.c_str(), yaw.c_str());
}

Table tableOf(const LogComparison& comparison) {
  Table table{{"model", "median", "rms", "heading, median", "heading, rms"}, {}, 1};
  const auto add = [&](const std::string& name, const EndErrors& errors) {
    table.rows.push_back({name, shownDistance(errors.position.median),
                          shownDistance(errors.position.rms), shownAngle(errors.yaw.median),
                          shownAngle(errors.yaw.rms)});
  };
  add("before: as it is", comparison.first);
  add("after: what if", comparison.second);
  return table;
}

/// Full speed of the manoeuvres and its reason.
std::string fullSpeedText(const ModelDocument& first, double full) {
  if (first.vehicle.kind == CommandKind::kPower)
    return "full power (" + threeDigits(first.vehicle.full_speed) + " m/s by the model)";
  const std::string speed = threeDigits(full) + " m/s";
  if (!first.envelope || first.envelope->v <= 0.0)
    return speed + " (the model's file has no envelope)";
  return speed + " (a quarter above the " + threeDigits(first.envelope->v) +
         " m/s of the model's envelope)";
}

}  // namespace

void turnOff(ModelDocument& model, const Effect& effect) {
  const ModelDocument nominal{};
  for (const EffectParameter& parameter : effect.parameters)
    valueOf(model, parameter) = valueOf(nominal, parameter);
}

void turnOn(ModelDocument& model, const Effect& effect) {
  turnOff(model, effect);
  valueOf(model, effect.parameters.front()) = effect.parameters.front().typical;
  for (const EffectParameter& parameter : effect.parameters)
    if (parameter.role == ParameterRole::kShape) valueOf(model, parameter) = parameter.typical;
}

namespace {

/// Removes an unnamed term from a model; false if there is none of that name.
bool removeTerm(ModelDocument& model, const std::string& name) {
  std::vector<UnnamedTerm>& terms = model.vehicle.unnamed;
  const auto term = std::find_if(terms.begin(), terms.end(),
                                 [&name](const UnnamedTerm& one) { return one.name == name; });
  if (term == terms.end()) return false;
  terms.erase(term);
  return true;
}

}  // namespace

ModelDocument changed(const ModelDocument& model, const ModelChange& change) {
  ModelDocument other = model;
  for (const std::string& name : change.remove) {
    if (removeTerm(other, name)) continue;
    const Effect& effect = effectOrNear(name);
    if (!isOn(effect, model))
      throw std::runtime_error("--remove " + name + ": it is off in this model");
    turnOff(other, effect);
  }
  const Effect* last_added = nullptr;
  for (const std::string& name : change.add) {
    last_added = &effectOrNear(name);
    requireOf("--add", name, model.vehicle.layout());
    if (isOn(*last_added, other))
      throw std::runtime_error(
          "--add " + name + ": it is already on in this model; another size: " + "--set " + name +
          "." + firstStrength(*last_added) + "=NUMBER, without it: --remove " + name);
    turnOn(other, *last_added);
  }
  for (const std::string& assignment : change.set) set(other, assignment, last_added);
  return other;
}

using namespace report;

double fullCommand(const ModelDocument& first, const ModelDocument& second) {
  return std::max(fullCommand(first), fullCommand(second));
}

std::string settingOf(const ModelDocument& first, const ModelDocument& second,
                      const std::string& model_file, const std::string& log_file) {
  std::string text = "Model: " + model_file + ". Full speed of the manoeuvres: " +
                     fullSpeedText(first, fullCommand(first, second)) + ".";
  if (!log_file.empty()) text += " Log: " + log_file + ".";
  return text +
         " Before: the model as it is; after: the changed model. Headings: after minus before, "
         "left positive.";
}

std::vector<ManoeuvreComparison> compareModels(const ModelDocument& first,
                                               const ModelDocument& second,
                                               const Circumstances& circumstances) {
  std::vector<ManoeuvreComparison> comparisons;
  for (const Manoeuvre& manoeuvre : standardManoeuvres(fullCommand(first, second))) {
    ManoeuvreComparison comparison;
    comparison.name = manoeuvre.name;
    comparison.first = posesOf(drivenByModel(first, manoeuvre, circumstances));
    comparison.second = posesOf(drivenByModel(second, manoeuvre, circumstances));
    const Pose2 ends = between(comparison.first.back(), comparison.second.back());
    comparison.position = ends.position().norm();
    comparison.yaw = ends.yaw;
    comparisons.push_back(std::move(comparison));
  }
  return comparisons;
}

LogComparison compareOnLog(const Drive& drive, const ModelDocument& first,
                           const ModelDocument& second) {
  const std::vector<Drive> drives{drive};
  const Observations data(drives, ObservationSettings{});
  const std::vector<ExecutionError> errors = endErrors(data, first);
  LogComparison comparison{summaryOf(errors), summaryOf(endErrors(data, second)), {}};
  const OverlayMaker maker(data, first, second);
  for (const ExecutionError& error : errors) comparison.overlays.push_back(maker.of(error));
  std::stable_sort(comparison.overlays.begin(), comparison.overlays.end(),
                   [](const Overlay& a, const Overlay& b) { return apart(a) > apart(b); });
  if (comparison.overlays.size() > kShownExecutions) comparison.overlays.resize(kShownExecutions);
  return comparison;
}

std::string textOf(const std::vector<ManoeuvreComparison>& comparisons) {
  std::string text = row("manoeuvre of 2 s", "ends apart", "heading");
  bool any = false;
  for (const ManoeuvreComparison& comparison : comparisons) {
    text += row(comparison.name, shownDistance(comparison.position), shownAngle(comparison.yaw));
    any = any || comparison.position > kRounding || std::abs(comparison.yaw) > kRounding;
  }
  if (!any)
    text +=
        "No manoeuvre shows a difference. Effects of slope, battery, heat or time need "
        "--pitch, --roll, --battery-drop, --minutes or --worked.\n";
  return text;
}

std::string textOf(const LogComparison& comparison) {
  std::string text = std::to_string(comparison.first.executions) +
                     " executions of the log, errors after 2 s, median (rms)\n";
  const auto add = [&](const std::string& name, const EndErrors& errors) {
    text += row(name, shownDistance(errors.position.median), shownAngle(errors.yaw.median)) +
            row("", "(" + shownDistance(errors.position.rms) + ")",
                "(" + shownAngle(errors.yaw.rms) + ")");
  };
  add("before: model as it is", comparison.first);
  add("after: what if", comparison.second);
  return text;
}

Page pageOf(const std::string& question, const std::string& setting,
            const std::vector<ManoeuvreComparison>& comparisons,
            const std::vector<LogComparison>& on_log) {
  Page page;
  page.title = question + " - tread-gap what-if";
  page.verdict = question;
  page.mood = "change";
  page.first = {Paragraph{setting}};
  if (!comparisons.empty()) {
    Table table{{"manoeuvre", "ends apart", "heading"}, {}, 1};
    for (const ManoeuvreComparison& comparison : comparisons)
      table.rows.push_back(
          {comparison.name, shownDistance(comparison.position), shownAngle(comparison.yaw)});
    page.first = {Paragraph{"The same commands, simulated with the present and the changed model; "
                            "differences after two seconds."},
                  Paragraph{setting}, table};
    page.sections.push_back(
        {"Manoeuvres",
         {Pictures{picturesOf(comparisons),
                   "Orange, dashed: present model. Blue: changed model. Ahead is up."}}});
  }
  for (const LogComparison& comparison : on_log)
    page.sections.push_back(
        {"On the log",
         {tableOf(comparison), Pictures{picturesOf(comparison),
                                        "The executions with the largest differences; old: present "
                                        "model, new: changed model."}}});
  return page;
}

std::string svgOf(const std::vector<ManoeuvreComparison>& comparisons,
                  const std::vector<LogComparison>& on_log) {
  std::vector<std::string> pictures = picturesOf(comparisons);
  for (const LogComparison& comparison : on_log)
    for (std::string& more : picturesOf(comparison)) pictures.push_back(std::move(more));
  return sheetOf(pictures, 3);
}

}  // namespace tread::gap
