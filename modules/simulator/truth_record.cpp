// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/truth_record.hpp"

#include <cstdio>
#include <fstream>
#include <stdexcept>

#include "common/report/text.hpp"

namespace tread::sim {
namespace {

constexpr int64_t kRowEvery = 20'000;  // [us]
constexpr const char* kHeader =
    "utime_us,x_m,y_m,yaw_rad,v_mps,left,right,surface,contacts,distance_m";
constexpr int64_t kFlushEvery = 500'000;  // [us]

}  // namespace

TruthRecord::TruthRecord(std::ostream& out) : out_(out) {
  out_ << kHeader << "\n";
}

void TruthRecord::note(const RobotTruth& truth, const std::array<double, 2>& power) {
  const bool due = last_row_ == INT64_MIN || truth.utime - last_row_ >= kRowEvery;
  if (!due && power == power_) return;
  power_ = power;
  last_row_ = truth.utime;
  out_ << formatted("%lld,%.4f,%.4f,%.5f,%.4f,%.3f,%.3f,%s,%zu,%.3f\n",
                    static_cast<long long>(truth.utime), truth.T_map_body.x, truth.T_map_body.y,
                    truth.T_map_body.yaw, truth.v_body.v_x, power[0], power[1],
                    truth.surface.c_str(), truth.collisions.size(), truth.distance);
  if (last_flush_ != INT64_MIN && truth.utime - last_flush_ < kFlushEvery) return;
  last_flush_ = truth.utime;
  out_.flush();
}

std::vector<TruthRow> readTruthRecord(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  if (!file || !std::getline(file, line) || line != kHeader)
    throw std::runtime_error(path + ": is no record of a simulation's truth; " +
                             "tread-simulator --set record=FILE writes one");
  std::vector<TruthRow> rows;
  while (std::getline(file, line)) {
    if (file.eof()) break;  // the last one may be half written
    TruthRow row;
    long long utime = 0;
    char surface[64];
    Pose2& pose = row.T_map_body;
    const int count = std::sscanf(line.c_str(), "%lld,%lf,%lf,%lf,%lf,%lf,%lf,%63[^,],%d,%lf",
                                  &utime, &pose.x, &pose.y, &pose.yaw, &row.speed, &row.power[0],
                                  &row.power[1], surface, &row.contacts, &row.distance);
    if (count != 10)
      throw std::runtime_error(path + ":" + std::to_string(rows.size() + 2) + ": not a row");
    row.utime = utime;
    row.surface = surface;
    rows.push_back(row);
  }
  return rows;
}

}  // namespace tread::sim
