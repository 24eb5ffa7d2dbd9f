// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/models/model_comparison.hpp"

#include <cmath>
#include <functional>
#include <map>

#include "modules/identification/core/discovery.hpp"
#include "modules/identification/core/end_errors.hpp"
#include "modules/identification/core/search_steps.hpp"

namespace tread::gap {
namespace {

MeanDifference meanOf(const std::vector<double>& values, const std::vector<ExecutionError>& where) {
  MeanDifference difference;
  if (values.empty()) return difference;
  const auto count = static_cast<double>(values.size());
  for (double value : values) difference.mean += value / count;
  std::map<int, double> of_block;
  for (size_t i = 0; i < values.size(); ++i)
    of_block[where[i].block] += values[i] - difference.mean;
  const auto blocks = static_cast<double>(of_block.size());
  if (blocks < 2.0) return {difference.mean, kNotMeasured};
  double squares = 0.0;
  for (const auto& [block, sum] : of_block) squares += sum * sum;
  difference.error = std::sqrt(squares * blocks / (blocks - 1.0)) / count;
  return difference;
}

constexpr int kLeastForNestedEffects = 2 * kLeastBlocks;  // as in find

using RungErrors = std::array<std::optional<std::vector<ExecutionError>>, kRungs>;

std::string joinedNames(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  return all.empty() ? "nothing" : all;
}

void sayFound(const RungModel& rung, const Progress& say) {
  say("  discovered: " + joinedNames(rung.effects));
}

/// Adds the errors of a fold's models on executions that count.
void addErrors(const Observations& data, const RungModels& models,
               const std::function<bool(const ExecutionError&)>& counts, RungErrors& all) {
  for (size_t r = 0; r < kRungs; ++r) {
    if (!models[r]) continue;
    if (!all[r]) all[r].emplace();
    for (const ExecutionError& error : endErrors(data, *models[r]))
      if (counts(error)) all[r]->push_back(error);
  }
}

void summarise(const RungErrors& errors, ComparisonRow& row) {
  for (size_t r = 0; r < kRungs; ++r) {
    if (!errors[r]) continue;
    row.errors[r] = summaryOf(*errors[r]);
    if (r != kFound && errors[kFound]) row.behind[r] = differenceOf(*errors[r], *errors[kFound]);
  }
}

/// Why a log allows no conclusion; empty if it is sound.
std::string fatalNote(const Drive& drive) {
  for (const LogNote& note : drive.notes)
    if (note.isFatal()) return note.what;
  return "";
}

ComparisonRow rowOf(const Drive& drive, const Observations& data) {
  ComparisonRow row;
  row.log = drive.name;
  row.blocks = data.measuredBlocks();
  row.driven = drive.driven();
  row.floor = deadReckoningFloor(data.drives());
  row.remark = fatalNote(drive);
  return row;
}

/// The search on a whole log, for the rung of one of its halves.
class Discoverer {
 public:
  Discoverer(const Fitter& fitter, const ModelDocument& ideal, uint64_t seed, bool nested,
             const Progress& say)
      : ideal_(ideal), seed_(seed), say_(say) {
    if (nested) return;
    say_("  effects on the whole log");
    whole_ = searchOn(fitter);
  }

  RungModel on(const Fitter& rows) const {
    say_("  search");
    RungModel rung;
    if (whole_) {
      rung = discoveredRung(*whole_, refitted(rows, *whole_));
    } else {
      const FoundTerms found = searchOn(rows);
      rung = discoveredRung(found, found.state);
    }
    sayFound(rung, say_);
    return rung;
  }

 private:
  FoundTerms searchOn(const Fitter& rows) const {
    const ModelDocument begin = calibratedNumbers(rows, ideal_);
    const Progress silent = [](const std::string&) {};
    return discover(rows, begin, seed_, silent);
  }

  const ModelDocument& ideal_;
  uint64_t seed_;
  const Progress& say_;
  std::optional<FoundTerms> whole_;
};

ComparisonRow nestedRow(const ComparisonLog& log, const ComparisonTask& task, const Progress& say) {
  const std::vector<Drive> drives{log.drive};
  const Observations data(drives, {});
  ComparisonRow row = rowOf(log.drive, data);
  say(row.log + ": " + std::to_string(row.blocks) + " blocks");
  if (row.remark.empty()) row.remark = tooLittleDriving(data);
  if (!row.remark.empty()) {
    say("  left out: " + row.remark);
    return row;
  }
  const Fitter fitter(data, task.parallel);
  row.structure_nested = row.blocks >= kLeastForNestedEffects;
  const Discoverer discoverer(fitter, log.ideal, task.seed, row.structure_nested, say);
  RungErrors errors;
  for (int half : {0, 1}) {
    say("  from half " + std::to_string(half + 1));
    const Fitter rows = fitter.onRows(halfMask(data, half));
    ComparisonFold fold;
    fold.trained_on = "half " + std::to_string(half + 1);
    fold.models = fitRungs(rows, log.ideal, log.ideal_known, say);
    fold.models[kFound] = discoverer.on(rows);
    addErrors(
        data, fold.models, [half](const ExecutionError& error) { return error.block % 2 != half; },
        errors);
    row.folds.push_back(std::move(fold));
  }
  summarise(errors, row);
  return row;
}

ComparisonRow pooledRow(const ComparisonTask& task, size_t left_out, const Progress& say) {
  const ComparisonLog& log = task.logs[left_out];
  std::vector<Drive> train;
  for (size_t i = 0; i < task.logs.size(); ++i) {
    const bool sound = fatalNote(task.logs[i].drive).empty();
    if (i != left_out && sound) train.push_back(task.logs[i].drive);
  }
  const std::vector<Drive> test{log.drive};
  const Observations test_data(test, {});
  ComparisonRow row = rowOf(log.drive, test_data);
  const Observations data(train, {});
  say(row.log + " left out, from " + std::to_string(data.blocks()) + " blocks of the others");
  if (row.remark.empty() && !tooLittleDriving(data).empty())
    row.remark = "of the others " + tooLittleDriving(data);
  if (!row.remark.empty()) {
    say("  left out: " + row.remark);
    return row;
  }
  const Fitter fitter(data, task.parallel);
  ComparisonFold fold;
  fold.trained_on = "all but " + row.log;
  fold.models = fitRungs(fitter, log.ideal, log.ideal_known, say);
  fold.models[kFound] = Discoverer(fitter, log.ideal, task.seed, true, say).on(fitter);
  RungErrors errors;
  addErrors(
      test_data, fold.models, [](const ExecutionError&) { return true; }, errors);
  row.folds.push_back(std::move(fold));
  summarise(errors, row);
  return row;
}

}  // namespace

RungDifference differenceOf(const std::vector<ExecutionError>& first,
                            const std::vector<ExecutionError>& second) {
  std::vector<double> yaw;
  std::vector<double> position;
  for (size_t i = 0; i < first.size(); ++i) {
    yaw.push_back(second[i].yaw - first[i].yaw);
    position.push_back(second[i].position - first[i].position);
  }
  return {meanOf(yaw, first), meanOf(position, first)};
}

std::string unusable(const Drive& drive) {
  const std::string fatal = fatalNote(drive);
  if (!fatal.empty()) return fatal;
  const std::vector<Drive> drives{drive};
  return tooLittleDriving(Observations(drives, {}));
}

ModelComparison compareOnLogs(const ComparisonTask& task, const Progress& say) {
  ModelComparison comparison;
  comparison.seed = task.seed;
  for (const ComparisonLog& log : task.logs) comparison.nested.push_back(nestedRow(log, task, say));
  for (size_t i = 0; task.pool && i < task.logs.size(); ++i)
    comparison.pooled.push_back(pooledRow(task, i, say));
  return comparison;
}

}  // namespace tread::gap
