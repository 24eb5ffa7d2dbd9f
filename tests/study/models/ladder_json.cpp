// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>

#include "tests/study/models/ladder_output.hpp"
#include "tools/gap/report/sections.hpp"

namespace tread::gap {
namespace {

using Json = nlohmann::ordered_json;

constexpr auto kFoundRung = static_cast<size_t>(Rung::kDiscovered);

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json errorsJson(const EndErrors& errors) {
  const auto figure = [](const ErrorFigure& of) {
    return Json{{"median", number(of.median)}, {"rms", number(of.rms)}};
  };
  return {{"executions", errors.executions},
          {"yaw_rad", figure(errors.yaw)},
          {"position_m", figure(errors.position)}};
}

Json differenceJson(const RungDifference& behind) {
  const auto difference = [](const MeanDifference& of) {
    return Json{{"mean", number(of.mean)}, {"error", number(of.error)}};
  };
  return {{"yaw_rad", difference(behind.yaw)}, {"position_m", difference(behind.position)}};
}

Json foldJson(const LadderFold& fold) {
  Json fitted = Json::object();
  for (size_t r = 0; r < kRungs; ++r) {
    if (!fold.models[r]) continue;
    Json numbers = Json::object();
    for (const auto& [path, value] : fold.models[r]->numbers) numbers[path] = number(value);
    fitted[rungKey(static_cast<Rung>(r))] = numbers;
  }
  Json effects = nullptr;
  if (fold.models[kFoundRung]) effects = fold.models[kFoundRung]->effects;
  return {{"trained_on", fold.trained_on}, {"effects", effects}, {"fitted", fitted}};
}

Json rowJson(const LadderRow& row, const std::string& sha256) {
  Json rungs = Json::object();
  Json less = Json::object();
  for (size_t r = 0; r < kRungs; ++r) {
    const char* key = rungKey(static_cast<Rung>(r));
    if (row.errors[r]) rungs[key] = errorsJson(*row.errors[r]);
    if (row.behind[r]) less[key] = differenceJson(*row.behind[r]);
  }
  Json folds = Json::array();
  for (const LadderFold& fold : row.folds) folds.push_back(foldJson(fold));
  return {{"log", row.log},          {"sha256", sha256},
          {"blocks", row.blocks},    {"driven_s", number(row.driven)},
          {"remark", row.remark},    {"structure_nested", row.structure_nested},
          {"rungs", rungs},          {"floor", row.floor ? errorsJson(*row.floor) : Json(nullptr)},
          {"discovered_less", less}, {"folds", folds}};
}

}  // namespace

nlohmann::ordered_json ladderJson(const LadderReport& report) {
  const auto rows = [&report](const std::vector<LadderRow>& of) {
    Json all = Json::array();
    for (size_t i = 0; i < of.size(); ++i) all.push_back(rowJson(of[i], report.sha256[i]));
    return all;
  };
  return {{"tool", toolVersion()},
          {"seed", report.ladder.seed},
          {"model", report.model},
          {"nested", rows(report.ladder.nested)},
          {"pooled", rows(report.ladder.pooled)}};
}

}  // namespace tread::gap
