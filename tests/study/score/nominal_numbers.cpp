// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/score/nominal_numbers.hpp"

#include <cmath>

#include "common/vehicle/model_file.hpp"

namespace tread::blindtest {
namespace {

using Json = nlohmann::ordered_json;

Json sigmaOf(const ParameterCovariance& covariance, const std::string& path) {
  for (size_t i = 0; i < covariance.parameters.size(); ++i)
    if (covariance.parameters[i] == path) return std::sqrt(covariance.matrix[i][i]);
  return nullptr;
}

}  // namespace

Json nominalNumbers(const std::string& model, const Json& verdict) {
  Json numbers = Json::object();
  if (verdict.is_null()) return numbers;
  const ModelDocument document = readModelDocument(model);
  const auto add = [&](const std::string& path) {
    if (const double* value = findParameter(document, path))
      numbers[path] = {{"value", *value}, {"sigma", sigmaOf(document.covariance, path)}};
  };
  for (const auto& [path, estimate] : verdict.at("calibrated").items()) add(path);
  for (const Json& effect : verdict.at("effects"))
    for (const auto& [name, estimate] : effect.at("parameters").items())
      add(effect.at("name").get<std::string>() + "." + name);
  return numbers;
}

}  // namespace tread::blindtest
