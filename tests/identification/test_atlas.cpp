// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <map>
#include <stdexcept>

#include "core_rig.hpp"
#include "modules/identification/core/adequacy.hpp"
#include "modules/identification/core/variables.hpp"

using namespace tread;
using namespace tread::gap;
using samples::Rig;
using samples::vehicleWith;

namespace {

const AtlasCurve& curveOf(const ResidualAtlas& atlas, const std::string& channel,
                          const std::string& variable) {
  for (const AtlasCurve& curve : atlas.curves)
    if (curve.channel == channel && curve.variable == variable) return curve;
  throw std::out_of_range(channel + " over " + variable);
}

Eigen::VectorXd valuesOf(const Rig& rig, const ModelDocument& model, const std::string& name) {
  for (const Variable& variable : variablesOf(rig.data, model))
    if (variable.name == name) return variable.values;
  throw std::out_of_range(name);
}

size_t markedIn(const std::vector<AtlasCell>& cells) {
  return static_cast<size_t>(
      std::count_if(cells.begin(), cells.end(), [](const AtlasCell& cell) { return cell.marked; }));
}

}  // namespace

TEST_CASE("curves of what is unexplained come first, also over variables that are not shown else") {
  const Rig rig({}, 200.0, 1);
  const ModelDocument model = syntheticVehicle();
  const size_t usual = residualAtlas(rig.data, model, model).curves.size();
  const std::vector<Unexplained> rests{{"along", "sign of v, just reversed", 5.0, 0.001},
                                       {"lateral", "v", 4.0, 0.005}};
  const std::vector<AtlasCurve> curves = residualAtlas(rig.data, model, model, rests).curves;
  REQUIRE(curves.size() == usual + 1);
  for (size_t i = 0; i < rests.size(); ++i) {
    CHECK(curves[i].channel == rests[i].channel);
    CHECK(curves[i].variable == rests[i].variable);
    CHECK(curves[i].unexplained);
  }
  CHECK_FALSE(curves[2].unexplained);
}

TEST_CASE("the cells of a curve share out all rows of its channel in neighbouring ranges") {
  const Rig rig({}, 200.0, 1);
  const ResidualAtlas atlas = residualAtlas(rig.data, syntheticVehicle(), syntheticVehicle());
  REQUIRE(atlas.curves.size() >= 4 * 6);
  std::map<std::string, size_t> rows;
  for (const Observation& row : rig.data.all()) ++rows[channelName(row.channel)];
  for (const AtlasCurve& curve : atlas.curves) {
    INFO(curve.channel << " over " << curve.variable);
    for (const std::vector<AtlasCell>* cells : {&curve.before, &curve.after}) {
      REQUIRE(cells->size() >= 2);
      size_t sum = 0;
      for (size_t c = 0; c < cells->size(); ++c) {
        const AtlasCell& cell = (*cells)[c];
        sum += cell.rows;
        CHECK(cell.from < cell.to);
        if (c > 0) CHECK(cell.from == (*cells)[c - 1].to);
        CHECK(cell.low <= cell.mean);
        CHECK(cell.mean <= cell.high);
      }
      CHECK(sum == rows.at(curve.channel));
    }
  }
}

TEST_CASE("a cell's mean is that of the residuals whose variable lies in it") {
  const Rig rig({{"slip_ratio.slip", 0.1}}, 120.0, 2);
  const ModelDocument nominal = syntheticVehicle();
  const ModelDocument after = vehicleWith({{"slip_ratio.slip", 0.1}});
  const ResidualAtlas atlas = residualAtlas(rig.data, nominal, after);
  const Eigen::VectorXd v = valuesOf(rig, nominal, "v");
  for (const ModelDocument& model : {nominal, after}) {
    const Eigen::VectorXd residuals = rig.data.residuals(rig.data.predict(model));
    const AtlasCurve& curve = curveOf(atlas, "along", "v");
    const auto& looked = model.vehicle.effects.slip_ratio != 0.0 ? curve.after : curve.before;
    for (size_t c = 0; c < looked.size(); ++c) {
      double sum = 0.0;
      size_t count = 0;
      for (Eigen::Index i = 0; i < residuals.size(); ++i) {
        if (rig.data.all()[static_cast<size_t>(i)].channel != ObservedRate::kAlong) continue;
        const bool within =
            v[i] >= looked[c].from && (v[i] < looked[c].to || c + 1 == looked.size());
        if (!within) continue;
        sum += residuals[i];
        ++count;
      }
      CHECK(looked[c].rows == count);
      CHECK(looked[c].mean == Approx(sum / static_cast<double>(count)));
    }
  }
}

TEST_CASE("cells of a variable that changes smoothly have about equally many rows") {
  const Rig rig({}, 200.0, 3);
  const ResidualAtlas atlas = residualAtlas(rig.data, syntheticVehicle(), syntheticVehicle());
  const std::vector<AtlasCell>& cells = curveOf(atlas, "yaw rate", "elapsed time").before;
  REQUIRE(cells.size() == 9);
  for (const AtlasCell& cell : cells) {
    CHECK(cell.rows + 2 >= cells[0].rows);
    CHECK(cell.rows <= cells[0].rows + 2);
  }
  CHECK(cells.front().from < 1.0);
  CHECK(cells.back().to > 199.0);
}

TEST_CASE("a bias is marked in the model that lacks it, and nowhere in the one that has it") {
  const Rig rig({{"gyro_bias.rate", 0.06}}, 300.0, 4);
  const ResidualAtlas atlas =
      residualAtlas(rig.data, syntheticVehicle(), vehicleWith({{"gyro_bias.rate", 0.06}}));
  const AtlasCurve& curve = curveOf(atlas, "yaw rate", "elapsed time");
  double mean = 0.0;
  for (const AtlasCell& cell : curve.before) mean += cell.mean / 9.0;
  CHECK(mean == Approx(0.06).margin(0.01));
  const AtlasCurve& speed = curveOf(atlas, "yaw rate", "v");
  CHECK(markedIn(speed.before) >= 5);
  CHECK(markedIn(speed.after) == 0);
  CHECK(speed.unit == "rad/s");
  CHECK(speed.variable_unit == "m/s");
}

TEST_CASE("a drive of the model itself has hardly a mark among hundreds of cells") {
  size_t marked = 0;
  size_t cells = 0;
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    const Rig rig({}, 240.0, seed);
    for (const AtlasCurve& curve :
         residualAtlas(rig.data, syntheticVehicle(), syntheticVehicle()).curves) {
      marked += markedIn(curve.before);
      cells += curve.before.size();
    }
  }
  CHECK(cells > 800);
  CHECK(marked <= 2);
}

TEST_CASE("less than four blocks say no interval, and mark nothing") {
  const Rig rig({{"gyro_bias.rate", 0.2}}, 60.0, 5);
  REQUIRE(rig.data.blocks() == 3);
  const ResidualAtlas atlas = residualAtlas(rig.data, syntheticVehicle(), syntheticVehicle());
  REQUIRE_FALSE(atlas.curves.empty());
  for (const AtlasCurve& curve : atlas.curves) {
    CHECK(markedIn(curve.before) == 0);
    for (const AtlasCell& cell : curve.before) CHECK(std::isinf(cell.high));
  }
  const std::vector<Drive> none(1);
  const Observations empty(none, {});
  CHECK(residualAtlas(empty, syntheticVehicle(), syntheticVehicle()).curves.empty());
}

TEST_CASE(
    "a field of a map is the mean of four rows at least, and never driven where there is none") {
  const Rig rig({{"slip_ratio.slip", 0.1}}, 120.0, 6);
  const ModelDocument nominal = syntheticVehicle();
  const ResidualAtlas atlas = residualAtlas(rig.data, nominal, nominal);
  REQUIRE(atlas.maps.size() == kChannels);
  const Eigen::VectorXd v = valuesOf(rig, nominal, "v");
  const Eigen::VectorXd omega = valuesOf(rig, nominal, "yaw rate");
  const Eigen::VectorXd residuals = rig.data.residuals(rig.data.predict(nominal));
  const AtlasMap& map = atlas.maps[static_cast<size_t>(ObservedRate::kAlong)];
  CHECK(map.channel == "along");
  const size_t columns = map.v_edges.size() - 1;
  const size_t lines = map.omega_edges.size() - 1;
  REQUIRE(map.before.size() == columns * lines);
  size_t empty = 0;
  for (size_t line = 0; line < lines; ++line)
    for (size_t column = 0; column < columns; ++column) {
      double sum = 0.0;
      int count = 0;
      const auto inside = [](const std::vector<double>& edges, size_t at, double value) {
        return value >= edges[at] &&
               (value < edges[at + 1] || (at + 2 == edges.size() && value <= edges[at + 1]));
      };
      for (Eigen::Index i = 0; i < v.size(); ++i) {
        if (rig.data.all()[static_cast<size_t>(i)].channel != ObservedRate::kAlong) continue;
        if (!inside(map.v_edges, column, v[i]) || !inside(map.omega_edges, line, omega[i]))
          continue;
        sum += residuals[i];
        ++count;
      }
      const double mean = map.before[line * columns + column];
      CHECK(std::isnan(mean) == (count < 4));
      if (count >= 4) CHECK(mean == Approx(sum / count));
      empty += count < 4;
    }
  CHECK(empty > 0);
  CHECK(empty < map.before.size());
}
