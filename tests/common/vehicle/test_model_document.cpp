// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <string>

#include <catch2/catch.hpp>

#include "common/config/config_reader.hpp"
#include "common/vehicle/model_file.hpp"

using namespace tread;

namespace {

const std::string kDocumentHead = "name: m\nkind: power\nfull_speed: 1.1\ngauge: 0.6\n";  // 4 lines
const std::string kEffect = "effects:\n  icr_offset:\n    offset: 0.1\n";                 // 3 lines

void expectDocumentError(const std::string& text, const std::string& place,
                         const std::string& part) {
  std::string message = "no error";
  try {
    parseModelDocument(text, "m.yaml");
  } catch (const ConfigError& error) {
    message = error.what();
  }
  INFO(message);
  CHECK(message.find("m.yaml:" + place + ": ") == 0);
  CHECK(message.find(part) != std::string::npos);
  CHECK(message.find('\n') == std::string::npos);
}

ModelDocument fullDocument() {
  ModelDocument document = parseModelDocument(kDocumentHead + kEffect, "m.yaml");
  document.measurement.ins_latency = 0.1 / 3.0;
  document.measurement.lever_arm_y = -1.0 / 7.0;
  document.bounds = {{"icr_offset.offset", -0.1 / 3.0, 0.2}, {"yaw_gain", 0.5, 1.1}};
  document.covariance.parameters = {"icr_offset.offset", "ins_latency.latency", "yaw_gain"};
  document.covariance.matrix = {
      {1e-4 / 3.0, 1e-9, 0.0}, {1e-9, 2e-5, -1e-7}, {0.0, -1e-7, 1.0 / 3e6}};
  document.rest = {{"yaw rate", "sign of v, just reversed", -0.1 / 3.0, 1.0 / 7e3},
                   {"along", "|v| x yaw rate", 1e-3 / 7.0, 0.0}};
  document.provenance = {"tread-gap 0.1",
                         42,
                         3,
                         {{"a: log.lcm", std::string(64, 'a')}},
                         {{"yaw_pull", true, "Anna: Berg"}, {"grip_limit", false, ""}}};
  document.envelope = Envelope{1.1 / 3.0, 0.7, 0.1 + 0.2};
  return document;
}

}  // namespace

TEST_CASE("Everything in a model file comes back bit for bit") {
  const ModelDocument document = fullDocument();
  const std::string text = formatModelDocument(document);
  const ModelDocument again = parseModelDocument(text, "again.yaml");
  CHECK(formatModelDocument(again) == text);
  CHECK(again.measurement.ins_latency == document.measurement.ins_latency);
  CHECK(again.measurement.lever_arm_y == document.measurement.lever_arm_y);
  REQUIRE(again.bounds.size() == 2);
  CHECK(again.bounds[0].parameter == "icr_offset.offset");
  CHECK(again.bounds[0].min == document.bounds[0].min);
  CHECK(again.covariance.parameters == document.covariance.parameters);
  CHECK(again.covariance.matrix == document.covariance.matrix);
  REQUIRE(again.rest);
  REQUIRE(again.rest->size() == 2);
  CHECK((*again.rest)[0].channel == "yaw rate");
  CHECK((*again.rest)[0].condition == "sign of v, just reversed");
  CHECK((*again.rest)[0].size == (*document.rest)[0].size);
  CHECK((*again.rest)[0].deviation == (*document.rest)[0].deviation);
  CHECK(again.provenance.tool == "tread-gap 0.1");
  CHECK(again.provenance.seed == document.provenance.seed);
  CHECK(again.provenance.runs == 3);
  REQUIRE(again.provenance.logs.size() == 1);
  CHECK(again.provenance.logs[0].name == "a: log.lcm");
  REQUIRE(again.provenance.decisions.size() == 2);
  CHECK(again.provenance.decisions[0].effect == "yaw_pull");
  CHECK(again.provenance.decisions[0].accepted);
  CHECK(again.provenance.decisions[0].by == "Anna: Berg");
  CHECK_FALSE(again.provenance.decisions[1].accepted);
  CHECK(again.provenance.decisions[1].by.empty());
  REQUIRE(again.envelope);
  CHECK(again.envelope->v_omega == document.envelope->v_omega);
}

TEST_CASE("A model that left nothing unexplained is another one than a model that does not say") {
  ModelDocument document = parseModelDocument(kDocumentHead, "m.yaml");
  CHECK_FALSE(document.rest);
  document.rest.emplace();
  const ModelDocument again = parseModelDocument(formatModelDocument(document), "again.yaml");
  REQUIRE(again.rest);
  CHECK(again.rest->empty());
}

TEST_CASE("The vehicle part and the measurement part of a file stand apart") {
  const ModelDocument document = fullDocument();
  const std::string text = formatModelDocument(document);
  const size_t measurement = text.find("\nmeasurement:");
  REQUIRE(measurement != std::string::npos);
  CHECK(text.find("icr_offset:") < measurement);
  CHECK(text.find("ins_latency:") > measurement);
  ModelDocument vehicle_alone;
  vehicle_alone.vehicle = document.vehicle;
  CHECK(formatModelDocument(vehicle_alone).find("ins_latency") == std::string::npos);
}

TEST_CASE("Bad bounds, covariances, origins and envelopes are refused in one clear line") {
  const std::string base = kDocumentHead + kEffect;  // 7 lines
  expectDocumentError(base + "bounds:\n  icr_offset: [-1, 1]\n", "9", "is no parameter");
  expectDocumentError(base + "bounds:\n  icr_offset.offset: [0.2, 0.3]\n", "9", "between");
  expectDocumentError(base + "bounds:\n  icr_offset.offset: [0.3]\n", "9", "2");
  expectDocumentError(base + "covariance:\n  parameters: [lag, lags]\n", "9",
                      "'lags' is no parameter");
  expectDocumentError(base + "covariance:\n  parameters: [lag, lag]\n", "9", "twice");
  const std::string two = base + "covariance:\n  parameters: [lag, delay]\n  matrix: ";
  expectDocumentError(two + "[[1, 0]]\n", "10", "one row per parameter");
  expectDocumentError(two + "[[1, 0], [0.1, 1]]\n", "10", "symmetric");
  expectDocumentError(two + "[[1, 0], [0, -1]]\n", "10", "negative");
  expectDocumentError(base + "rest:\n  - {channel: along, condition: v, size: 1}\n", "9",
                      "deviation");
  expectDocumentError(base + "rest:\n  - {channel: along, condition: v, size: 1, deviation: -1}\n",
                      "9", "deviation");
  expectDocumentError(base + "provenance:\n  seed: 1.5\n", "9", "seed");
  expectDocumentError(base + "provenance:\n  logs:\n    - name: a\n      sha256: beef\n", "11",
                      "64 digits");
  expectDocumentError(
      base + "provenance:\n  decisions:\n    - effect: yaw_pull\n      decision: maybe\n", "11",
      "accepted");
  expectDocumentError(
      base + "provenance:\n  decisions:\n    - effect: yaw_pul\n      decision: accepted\n", "10",
      "'yaw_pul' is no effect of the catalogue; did you mean yaw_pull?");
  expectDocumentError(base + "envelope:\n  v: 1\n", "8", "omega");
  expectDocumentError(base + "envelope:\n  v: -1\n  omega: 1\n  v_omega: 1\n", "9", "0..100 m/s");
  expectDocumentError(base + "measurement:\n  ins_latency:\n    latency: 3\n", "10", "-1..2 s");
}

TEST_CASE("Outside of its envelope a model warns, once for each quantity, within it is silent") {
  const Envelope known{1.0, 0.8, 0.5};
  CHECK(warningsOutside(known, known).empty());
  CHECK(warningsOutside(known, {0.5, 0.8, 0.1}).empty());
  const auto warnings = warningsOutside(known, {1.5, 0.2, 0.6});
  REQUIRE(warnings.size() == 2);
  CHECK(warnings[0] ==
        "speed up to 1.5 m/s is asked for, the model was made from up to 1 m/s: beyond it is "
        "guesswork");
  CHECK(warnings[1].find("speed times yaw rate") == 0);
}

TEST_CASE("The envelope of a drive holds its largest motions") {
  VehicleModel model = parseModelDocument(kDocumentHead, "m.yaml").vehicle;
  const Envelope envelope = envelopeOf(model, {{1.0, 1.0}, {-0.5, 0.5}, {-1.0, -1.0}}, 0.1, {});
  CHECK(envelope.v == Approx(1.1));
  CHECK(envelope.omega == Approx(1.1 / 0.6));
  CHECK(envelope.v_omega == Approx(0.0).margin(1e-12));
}

TEST_CASE("A path names every parameter of a document and nothing else") {
  ModelDocument document;
  for (const Effect& effect : effectCatalogue())
    for (const EffectParameter& parameter : effect.parameters)
      CHECK(findParameter(document, effect.name + "." + parameter.name) != nullptr);
  *findParameter(document, "lever_arm_x.offset") = 0.3;
  CHECK(document.measurement.lever_arm_x == 0.3);
  *findParameter(document, "yaw_gain") = 0.7;
  CHECK(document.vehicle.yaw_gain == 0.7);
  for (const char* path : {"rest.0", "rest.", "rest.x", "rest.0x", "rest.-1"})
    CHECK(findParameter(document, path) == nullptr);
  document.rest = {{"along", "v", 0.1, 0.01}, {"along", "v^2", 0.2, 0.01}};
  CHECK(findParameter(document, restPath(1)) == &(*document.rest)[1].size);
  CHECK(restTermOf("rest.1") == 1);
  CHECK(findParameter(document, "rest.2") == nullptr);
  CHECK(findParameter(document, "lever_arm_x") == nullptr);
  CHECK(findParameter(document, "") == nullptr);
}
