// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cstdio>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "common/config/command_line.hpp"
#include "common/config/problem_words.hpp"
#include "common/report/page.hpp"
#include "tests/study/hide/bad_log.hpp"
#include "tests/study/hide/case_folder.hpp"
#include "tests/study/hide/effect_list.hpp"
#include "tests/study/hide/semi.hpp"
#include "tests/study/hide/suite.hpp"

using namespace tread::blind;

namespace {

struct Arguments {
  std::string out;
  std::string suite;
  std::string kind;
  std::string programme = "full";
  std::string shard;
  bool null = false;
  double minutes = 10.0;
  CasePlan plan;
};

/// Index and number of shards.
struct Shard {
  size_t index = 1;
  size_t count = 1;
};

Shard shardOf(const std::string& text) {
  if (text.empty()) return {};
  Shard shard;
  if (std::sscanf(text.c_str(), "%zu/%zu", &shard.index, &shard.count) != 2 || shard.index < 1 ||
      shard.index > shard.count)
    throw std::invalid_argument("--shard: '" + text + "' is not I/N with 1 <= I <= N");
  return shard;
}

/// Kind of case for the options.
CaseKind kindOf(const Arguments& arguments) {
  const CasePlan& plan = arguments.plan;
  if (!plan.defect.empty()) return CaseKind::kBad;
  if (arguments.null || plan.effects.empty()) return CaseKind::kNull;
  if (plan.effects.size() == 2) return CaseKind::kPair;
  if (plan.effects.size() > 2) throw std::invalid_argument("--effect: at most two");
  if (effectNamed(plan.effects.front()).kind == EffectKind::kOutOfCatalogue)
    return CaseKind::kUnknown;
  return arguments.kind == "degenerate" ? CaseKind::kDegenerate : CaseKind::kSingle;
}

std::vector<CasePlan> plansOf(const Arguments& arguments) {
  if (!arguments.suite.empty())
    return suiteOf(arguments.suite, arguments.minutes, arguments.plan.seed);
  CasePlan plan = arguments.plan;
  plan.minutes = arguments.minutes;
  plan.kind = kindOf(arguments);
  plan.choice = choiceNamed(arguments.programme).value_or(Choice::kFull);
  if (!arguments.kind.empty() && arguments.kind != kindName(plan.kind))
    throw std::invalid_argument("--case " + arguments.kind + " does not fit the effects given");
  if (plan.kind == CaseKind::kNull) plan.size = 0.0;
  if (plan.kind == CaseKind::kDegenerate) {
    plan.group = effectNamed(plan.effects.front()).group;
    for (const auto& all : effectNamed(plan.effects.front()).together)
      plan.group.insert(plan.group.end(), all.begin(), all.end());
    plan.group.insert(plan.group.begin(), plan.effects.front());
  }
  return {plan};
}

void hide(const Arguments& arguments) {
  const Shard shard = shardOf(arguments.shard);
  const std::vector<CasePlan> plans = plansOf(arguments);
  size_t made = 0;
  for (size_t i = shard.index - 1; i < plans.size(); i += shard.count) {
    writeCase(arguments.out, plans[i].name, makeCase(plans[i]));
    ++made;
  }
  std::printf("%s: %zu of %zu cases hidden\n", arguments.out.c_str(), made, plans.size());
}

const char* kindText(EffectKind kind) {
  if (kind == EffectKind::kVehicle || kind == EffectKind::kVehicleVariant) return "vehicle";
  if (kind == EffectKind::kAdded) return "added";
  return kind == EffectKind::kOutOfCatalogue ? "unlisted" : "measurement";
}

void list() {
  for (const EffectSpec& effect : effectList())
    std::printf("%-22s %-12s %-9s %-6s %s\n", effect.name.c_str(), kindText(effect.kind),
                effect.form == EffectForm::kPhysical ? "physical" : "kinematic",
                effect.shape == EffectShape::kSame ? "same" : "other", effect.how.c_str());
  for (const std::string& defect : defectNames()) std::printf("%-22s bad log\n", defect.c_str());
}

/// Options of `semi`.
struct SemiArguments {
  std::string log;
  std::string effect;
  int size = 1;
  uint64_t seed = 1;
  std::string name = "0001";
  std::string out;
};

void hideInRecording(const SemiArguments& arguments) {
  MadeCase made;
  made.events = readLog(arguments.log);
  std::ifstream file(arguments.log, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  const SemiTruth truth = hideInLog(arguments.effect, arguments.size, arguments.seed, made.events);
  made.truth =
      semiTruthText(arguments.name, truth, arguments.size, arguments.seed, tread::sha256(bytes));
  writeCase(arguments.out, arguments.name, made);
  std::printf("%s: %s hidden in %s\n", arguments.out.c_str(), arguments.name.c_str(),
              arguments.log.c_str());
}

void addSemiOptions(CLI::App& semi, SemiArguments& arguments) {
  std::vector<std::string> names;
  for (const SemiEffect& effect : semiEffects()) names.push_back(effect.name);
  semi.add_option("--log", arguments.log, "LCM log of a recording from tread-import")
      ->required()
      ->check(CLI::ExistingFile);
  semi.add_option("--effect", arguments.effect)->required()->check(CLI::IsMember(names));
  semi.add_option("--size", arguments.size, "1 or 2")->check(CLI::Range(1, 2));
  semi.add_option("--seed", arguments.seed, "seed for the sign and the time of a change");
  semi.add_option("--name", arguments.name, "of the case")->capture_default_str();
  semi.add_option("--out", arguments.out, "folder that gets blind/ and truth/")->required();
}

/// Lists what may be known of a suite's cases in advance: NAME NOISE, one per line.
void listConditions(const std::string& suite, uint64_t seed) {
  for (const CasePlan& plan : suiteOf(suite, 1.0, seed))
    std::printf("%s %s\n", plan.name.c_str(), plan.noise.c_str());
}

void addOptions(CLI::App& app, Arguments& arguments) {
  app.add_option("--out", arguments.out, "folder that gets blind/ and truth/");
  app.add_option("--suite", arguments.suite, "all cases of a study")
      ->check(CLI::IsMember(suiteNames()));
  app.add_option("--shard", arguments.shard, "I/N: every N-th case of the suite from the I-th");
  app.add_option("--case", arguments.kind, "kind of one case; default: by its effects")
      ->check(CLI::IsMember({"null", "single", "pair", "out_of_catalogue", "degenerate", "bad"}));
  app.add_flag("--null", arguments.null, "hides nothing: the plain vehicle");
  app.add_option("--effect", arguments.plan.effects, "one, or two with a comma")->delimiter(',');
  app.add_option_function<std::string>("--effect-file", addEffectOfFile,
                                       "effect of a file (YAML, as in config/effects), to be "
                                       "hidden by its formula; --effect names it")
      ->trigger_on_parse();
  app.add_option("--bad", arguments.plan.defect, "corrupts the log in this way")
      ->check(CLI::IsMember(defectNames()));
  app.add_option("--size", arguments.plan.size, "1 is hardly visible, 2 usual, 4 large")
      ->check(CLI::Range(0.01, 4.0))
      ->capture_default_str();
  app.add_option("--noise", arguments.plan.noise)
      ->check(CLI::IsMember({"low", "mid", "high"}))
      ->capture_default_str();
  app.add_option("--programme", arguments.programme, "motion patterns to drive")
      ->check(CLI::IsMember({"full", "five_forward", "forward", "one_speed", "straight"}))
      ->capture_default_str();
  app.add_option("--minutes", arguments.minutes, "of each log")
      ->check(CLI::Range(0.5, 120.0))
      ->capture_default_str();
  app.add_option("--seed", arguments.plan.seed)->capture_default_str();
  app.add_option("--name", arguments.plan.name, "of one case")->capture_default_str();
}

int parseAndRun(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{"Hides effects in the simulator's ground truth: logs for blind tests"};
  addOptions(app, arguments);
  CLI::App* names = app.add_subcommand("list", "lists the effects and the kinds of bad logs");
  std::string suite = "small";
  uint64_t seed = 1;
  CLI::App* conditions = app.add_subcommand(
      "conditions", "lists name and noise of a suite's cases, which are not secret");
  conditions->add_option("--suite", suite)->required()->check(CLI::IsMember(suiteNames()));
  conditions->add_option("--seed", seed)->capture_default_str();
  SemiArguments semi;
  CLI::App* recording = app.add_subcommand("semi", "hides an effect in the log of a recording");
  addSemiOptions(*recording, semi);
  app.require_subcommand(0, 1);
  if (const auto code = tread::parseCommandLine(app, argc, argv)) return *code;
  if (*recording) return hideInRecording(semi), 0;
  if (*names) return list(), 0;
  if (*conditions) return listConditions(suite, seed), 0;
  if (arguments.out.empty()) throw std::invalid_argument("--out is missing");
  hide(arguments);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return parseAndRun(argc, argv);
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "tread-hide: %s\n", tread::wordsOf(problem).c_str());
    return 2;
  }
}
