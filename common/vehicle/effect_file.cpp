// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/vehicle/effect_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <sstream>
#include <stdexcept>

#include "common/config/config_reader.hpp"
#include "common/config/scalars.hpp"
#include "common/vehicle/added_effects.hpp"

namespace tread {
namespace {

constexpr Range kParameterRange{-1e6, 1e6};
constexpr size_t kMostOfOne = 8;       // parameters of one effect
constexpr double kUnchanged = 1e-9;    // [m/s or rad/s]
constexpr double kLeastChange = 1e-6;  // [m/s or rad/s] least change by which an effect counts
constexpr size_t kLongestText = 400;   // characters

const std::vector<std::string>& limitedNames() {
  static const std::vector<std::string> names{"nothing", "track_speed", "yaw_rate",
                                              "lateral_acceleration"};
  return names;
}

size_t placeIn(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<size_t>(
      std::distance(names.begin(), std::find(names.begin(), names.end(), name)));
}

/// Text for people, on one line.
void readWords(ConfigReader& reader, const char* key, std::string& text, bool required = false) {
  reader.text(key, text, required);
  if (text.size() > kLongestText)
    throw reader.error(key, "at most " + std::to_string(kLongestText) + " characters");
  std::replace(text.begin(), text.end(), '\n', ' ');
}

EffectParameter readOneParameter(ConfigReader& reader) {
  EffectParameter parameter;
  reader.text("name", parameter.name, true);
  readWords(reader, "unit", parameter.unit, true);
  reader.number("min", parameter.min, kParameterRange, parameter.unit, true);
  reader.number("max", parameter.max, kParameterRange, parameter.unit, true);
  if (!(parameter.min < parameter.max))
    throw reader.error("max", "must be above min; both are values that are just plausible");
  reader.number("typical", parameter.typical, {parameter.min, parameter.max}, parameter.unit, true);
  std::string role = "strength";
  reader.choice("role", role, {"strength", "shape"});
  if (role == "shape") parameter.role = ParameterRole::kShape;
  if (role == "strength" &&
      (parameter.min > 0.0 || parameter.max < 0.0 || parameter.typical == 0.0))
    throw reader.error("typical", "a strength is off at 0: 0 must be in its range and not typical");
  reader.numbers("probes", parameter.probes, 0, {parameter.min, parameter.max}, parameter.unit);
  if (role == "shape" && parameter.probes.empty()) parameter.probes = {parameter.typical};
  reader.flag("fitted", parameter.fitted);
  reader.number("gauges", parameter.gauges, {0.0, 100.0}, "1");
  readWords(reader, "positive", parameter.positive);
  readWords(reader, "negative", parameter.negative);
  return parameter;
}

/// For a limit that is stored as its reciprocal.
void readLimit(ConfigReader& reader, EffectParameter& parameter) {
  std::string limits = limitedNames().front();
  reader.choice("limits", limits, limitedNames());
  parameter.limited = static_cast<LimitedQuantity>(placeIn(limitedNames(), limits));
  reader.text("reciprocal_of", parameter.natural_name);
  readWords(reader, "reciprocal_unit", parameter.natural_unit);
  if (parameter.reciprocal() == parameter.natural_unit.empty())
    throw reader.error("reciprocal_of", "needs reciprocal_unit, and that needs it");
  if (parameter.reciprocal() && parameter.min != 0.0)
    throw reader.error("min", "of a reciprocal is 0: no limit");
}

bool isPlain(const std::string& name) {
  return !name.empty() && name.size() <= 40 && name[0] >= 'a' && name[0] <= 'z' &&
         name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string::npos;
}

void requireName(const ConfigReader& reader, const std::string& key, const std::string& name) {
  if (!isPlain(name))
    throw reader.error(
        key, "'" + name + "' is no name; write a-z, 0-9 and _, a letter first, at most 40");
}

std::vector<EffectParameter> readParameters(ConfigReader& reader,
                                            const std::vector<std::string>& quantities) {
  std::vector<EffectParameter> all;
  std::set<std::string> taken(quantities.begin(), quantities.end());
  taken.insert(kMemoryName);
  for (ConfigReader& one : reader.sections("parameters", true)) {
    all.push_back(readOneParameter(one));
    readLimit(one, all.back());
    requireName(one, "name", all.back().name);
    if (!taken.insert(all.back().name).second ||
        (all.back().reciprocal() && !taken.insert(all.back().natural_name).second))
      throw one.error("name", "'" + all.back().name + "' names something else already");
  }
  const auto strengths = std::count_if(all.begin(), all.end(), [](const EffectParameter& one) {
    return one.role == ParameterRole::kStrength;
  });
  if (strengths == 0 || all.front().role == ParameterRole::kShape || all.size() > kMostOfOne)
    throw reader.error("parameters", "one to " + std::to_string(kMostOfOne) +
                                         ", a strength first: the effect is off where it is 0");
  return all;
}

/// Typical values of a vehicle's quantities in a drive, in turn.
std::vector<std::vector<double>> sampleMotions(const std::vector<std::string>& quantities) {
  constexpr double kSamples[] = {0.0, 1.0, -1.0, 0.3, -0.7, 2.0};
  std::vector<std::vector<double>> motions;
  for (size_t i = 0; i < 36; ++i) {
    std::vector<double> motion;
    for (size_t n = 0; n < quantities.size(); ++n) {
      double value = i == 0 ? 0.0 : kSamples[(i * (n + 1) + i / 6) % 6];
      if (quantities[n] == "gauge") value = 0.8;
      if (quantities[n] == "side") value = i % 2 == 0 ? 1.0 : -1.0;
      if (quantities[n] == "moving") value = i == 0 ? 0.0 : 1.0;
      if (quantities[n] == "session_time") value = 100.0 * static_cast<double>(i);
      if (quantities[n] == "battery_drop") value = 0.01 * static_cast<double>(i % 6);
      motion.push_back(value);
    }
    motions.push_back(std::move(motion));
  }
  return motions;
}

/// The quantity that a law changes, by its place.
size_t changedPlace(LawTarget target) {
  static const char* const kNames[] = {"speed", "yaw_rate", "v", "v_y"};
  return placeIn(quantitiesOf(target), kNames[static_cast<size_t>(target)]);
}

/// A law with parameters, evaluated on sample motions.
class TriedLaw {
 public:
  TriedLaw(const AddedLaw& law, const std::vector<double>& parameters)
      : law_(law), quantities_(quantitiesOf(law.changes)), formula_(law.formula) {
    formulas_.push_back(&formula_);
    if (law.follows != nullptr) {
      memory_.emplace_back(law.follows);
      memory_.emplace_back(law.over);
      for (const FormulaUse& one : memory_) formulas_.push_back(&one);
    }
    for (size_t i = 0; i < parameters.size(); ++i) set(quantities_.size() + i, parameters[i]);
    memory_place_ = quantities_.size() + parameters.size();
  }

  /// Its largest change; throws if it is undefined.
  double largestChange() const {
    double largest = 0.0;
    for (const std::vector<double>& motion : sampleMotions(quantities_)) {
      for (size_t i = 0; i < motion.size(); ++i) set(i, motion[i]);
      if (!memory_.empty()) remember(motion);
      const double value = finite(formula_, *law_.formula, motion);
      largest = std::max(largest, std::abs(value - motion[changedPlace(law_.changes)]));
    }
    return largest;
  }

 private:
  void set(size_t place, double value) const {
    for (const FormulaUse* formula : formulas_) formula->input(place) = value;
  }

  /// A memory without delay equals its target; otherwise it may have any value.
  void remember(const std::vector<double>& motion) const {
    set(memory_place_, 0.5 * motion.front());
    const double target = finite(memory_[0], *law_.follows, motion);
    if (finite(memory_[1], *law_.over, motion) <= 0.0) set(memory_place_, target);
  }

  double finite(const FormulaUse& use, const Formula& formula,
                const std::vector<double>& motion) const {
    const double value = use.value();
    if (std::isfinite(value)) return value;
    std::string at;
    for (size_t i = 0; i < motion.size(); ++i)
      if (formula.text().find(quantities_[i]) != std::string::npos)
        at += (at.empty() ? "" : ", ") + quantities_[i] + " " + formatNumber(motion[i]);
    throw std::runtime_error("'" + formula.text() + "' has no finite value where " + at +
                             "; a division by 0 needs a condition: a != 0 ? b / a : 0");
  }

  const AddedLaw& law_;
  const std::vector<std::string>& quantities_;
  FormulaUse formula_;
  std::deque<FormulaUse> memory_;
  std::vector<const FormulaUse*> formulas_;
  size_t memory_place_ = 0;
};

/// An effect must be off while its strengths are 0, and each strength must change something.
void requireSense(const AddedLaw& law, const std::vector<EffectParameter>& parameters) {
  std::vector<double> values;
  for (const EffectParameter& parameter : parameters)
    values.push_back(parameter.role == ParameterRole::kShape ? parameter.typical : 0.0);
  if (TriedLaw(law, values).largestChange() > kUnchanged)
    throw std::runtime_error("'" + law.formula->text() + "' changes " +
                             quantitiesOf(law.changes)[changedPlace(law.changes)] +
                             " while all strengths are 0; at 0 an effect is off");
  for (size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i].role == ParameterRole::kShape) continue;
    std::vector<double> on = values;
    on[i] = parameters[i].typical;
    if (TriedLaw(law, on).largestChange() < kLeastChange)
      throw std::runtime_error("'" + law.formula->text() + "' does nothing with " +
                               parameters[i].name + " " + formatNumber(on[i]) +
                               ", its typical value; leave it out");
  }
}

std::shared_ptr<const Formula> readFormula(ConfigReader& reader, const char* key,
                                           const std::vector<std::string>& names) {
  std::string text;
  reader.text(key, text, true);
  try {
    return std::make_shared<const Formula>(text, names);
  } catch (const std::runtime_error& problem) {
    throw reader.error(key, problem.what());
  }
}

void readLaw(ConfigReader& reader, Effect& effect) {
  auto law = std::make_shared<AddedLaw>();
  std::string changes;
  reader.choice("changes", changes, lawTargetNames(), true);
  law->changes = static_cast<LawTarget>(placeIn(lawTargetNames(), changes));
  const std::vector<std::string>& quantities = quantitiesOf(law->changes);
  effect.parameters = readParameters(reader, quantities);
  std::vector<std::string> names = quantities;
  for (const EffectParameter& parameter : effect.parameters) names.push_back(parameter.name);
  const bool remembers = reader.has("memory_follows") || reader.has("memory_over");
  if (remembers) {
    names.emplace_back(kMemoryName);
    law->follows = readFormula(reader, "memory_follows", names);
    law->over = readFormula(reader, "memory_over", names);
  }
  law->formula = readFormula(reader, "to", names);
  try {
    requireSense(*law, effect.parameters);
  } catch (const std::runtime_error& problem) {
    throw reader.error("to", problem.what());
  }
  effect.equation = changes + " -> " + law->formula->text();
  if (remembers)
    effect.equation +=
        "; memory follows " + law->follows->text() + " with a lag of " + law->over->text() + " s";
  effect.law = std::move(law);
}

std::vector<ConfoundedGroup> readGroups(ConfigReader& reader, const std::string& name) {
  std::vector<ConfoundedGroup> groups;
  for (ConfigReader& one : reader.sections("confused_with")) {
    ConfoundedGroup group;
    group.name = name + "_" + std::to_string(groups.size() + 1);
    one.texts("effects", group.members, true);
    for (const std::string& member : group.members)
      if (findEffect(member) == nullptr)
        throw one.error("effects", "'" + member +
                                       "' is no effect of the catalogue; tread-gap explain lists "
                                       "them");
    group.members.insert(group.members.begin(), name);
    readWords(one, "when", group.when);
    readWords(one, "because", group.because, true);
    readWords(one, "separates", group.separates, true);
    one.flag("always", group.named_beside);
    groups.push_back(std::move(group));
  }
  return groups;
}

bool isSame(const EffectEntry& entry, const Effect& known) {
  return known.law != nullptr && formatEffect(entry) == formatEffect(entryOf(known));
}

void writeParameter(std::ostringstream& out, const EffectParameter& parameter) {
  const auto words = [&out](const char* key, const std::string& text) {
    if (!text.empty()) out << "    " << key << ": " << formatText(text) << '\n';
  };
  out << "  - name: " << parameter.name << '\n';
  words("unit", parameter.unit);
  if (parameter.role == ParameterRole::kShape) out << "    role: shape\n";
  out << "    min: " << formatNumber(parameter.min) << "\n    max: " << formatNumber(parameter.max)
      << "\n    typical: " << formatNumber(parameter.typical) << '\n';
  std::vector<std::string> probes;
  for (const double probe : parameter.probes) probes.push_back(formatNumber(probe));
  if (!probes.empty()) out << "    probes: [" << joinWords(probes) << "]\n";
  if (parameter.fitted) out << "    fitted: true\n";
  if (parameter.gauges > 0.0) out << "    gauges: " << formatNumber(parameter.gauges) << '\n';
  if (parameter.limited != LimitedQuantity::kNone)
    out << "    limits: " << limitedNames()[static_cast<size_t>(parameter.limited)] << '\n';
  words("reciprocal_of", parameter.natural_name);
  words("reciprocal_unit", parameter.natural_unit);
  words("positive", parameter.positive);
  words("negative", parameter.negative);
}

}  // namespace

EffectEntry readEffectEntry(ConfigReader& reader) {
  EffectEntry entry;
  Effect& effect = entry.effect;
  reader.text("name", effect.name, true);
  requireName(reader, "name", effect.name);
  readWords(reader, "title", effect.title, true);
  readWords(reader, "sentence", effect.sentence, true);
  readWords(reader, "negative_sentence", effect.negative_sentence);
  reader.text("channels", effect.channels, true);
  if (effect.channels.empty() || effect.channels.find_first_not_of("xyw") != std::string::npos)
    throw reader.error("channels", "of the residuals: x along, y across, w yaw rate; as xw");
  readLaw(reader, effect);
  readWords(reader, "looks_like", effect.looks_like, true);
  readWords(reader, "separates", effect.separates, true);
  readWords(reader, "check", effect.check, true);
  entry.groups = readGroups(reader, effect.name);
  return entry;
}

EffectEntry readEffectFile(const std::string& path) {
  ConfigReader reader = ConfigReader::fromFile(path);
  EffectEntry entry = readEffectEntry(reader);
  reader.finish();
  return entry;
}

void addEntry(EffectEntry entry, const ConfigReader& reader) {
  const std::string name = entry.effect.name;
  if (const Effect* known = findEffect(name)) {
    if (isSame(entry, *known)) return;
    throw reader.error("name", "'" + name +
                                   "' is in the catalogue already, and something else; "
                                   "choose another name");
  }
  if (findParameter(ModelDocument{}, name) != nullptr || name == "rest")
    throw reader.error("name", "'" + name + "' names something else already; choose another name");
  try {
    addEffect(std::move(entry.effect), std::move(entry.groups));
  } catch (const std::runtime_error& problem) {
    throw reader.error("parameters", problem.what());
  }
}

void addEffectsOf(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code failed;
  for (const auto& file : std::filesystem::directory_iterator(folder, failed))
    if (file.path().extension() == ".yaml") files.push_back(file.path().string());
  if (failed || files.empty())
    throw ConfigError(folder + ": is no folder with effects (*.yaml); config/effects is one");
  std::sort(files.begin(), files.end());
  for (const std::string& file : files) {
    ConfigReader reader = ConfigReader::fromFile(file);
    EffectEntry entry = readEffectEntry(reader);
    reader.finish();
    addEntry(std::move(entry), reader);
  }
}

std::string formatEffect(const EffectEntry& entry) {
  const Effect& effect = entry.effect;
  std::ostringstream out;
  const auto words = [&out](const char* key, const std::string& text) {
    if (!text.empty()) out << key << ": " << formatText(text) << '\n';
  };
  words("name", effect.name);
  words("title", effect.title);
  words("sentence", effect.sentence);
  words("negative_sentence", effect.negative_sentence);
  words("channels", effect.channels);
  words("changes", lawTargetNames()[static_cast<size_t>(effect.law->changes)]);
  if (effect.law->follows != nullptr) {
    words("memory_follows", effect.law->follows->text());
    words("memory_over", effect.law->over->text());
  }
  words("to", effect.law->formula->text());
  out << "parameters:\n";
  for (const EffectParameter& parameter : effect.parameters) writeParameter(out, parameter);
  words("looks_like", effect.looks_like);
  words("separates", effect.separates);
  words("check", effect.check);
  if (!entry.groups.empty()) out << "confused_with:\n";
  for (const ConfoundedGroup& group : entry.groups) {
    out << "  - effects: [" << joinWords({group.members.begin() + 1, group.members.end()}) << "]\n";
    if (!group.when.empty()) out << "    when: " << formatText(group.when) << '\n';
    out << "    because: " << formatText(group.because)
        << "\n    separates: " << formatText(group.separates) << '\n';
    if (group.named_beside) out << "    always: true\n";
  }
  return out.str();
}

EffectEntry entryOf(const Effect& effect) {
  EffectEntry entry{effect, {}};
  for (const ConfoundedGroup& group : confoundedGroups())
    if (group.members.front() == effect.name && group.name.rfind(effect.name + "_", 0) == 0)
      entry.groups.push_back(group);
  return entry;
}

}  // namespace tread
