// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/recordings/session.hpp"

#include "common/recordings/csv_table.hpp"

namespace tread::importer {
namespace {

double within(const CsvTable& table, size_t row, const std::string& name, double min, double max) {
  const double value = table.number(row, table.column(name));
  if (value < min || value > max)
    throw table.error(row, "column " + name + " is " + table.text(row, table.column(name)) +
                               "; allowed is " + std::to_string(min) + " to " +
                               std::to_string(max));
  return value;
}

}  // namespace

Session readSession(const std::string& sessions_path, const std::string& name) {
  const CsvTable table(sessions_path);
  const size_t names = table.column("session");
  for (size_t row = 0; row < table.rows(); ++row) {
    if (table.text(row, names) != name) continue;
    Session session;
    session.name = name;
    session.robot = table.text(row, table.column("robot"));
    session.surface = table.text(row, table.column("surface"));
    session.wheel_radius = within(table, row, "wheel_radius_m", 0.01, 2.0);
    session.baseline = within(table, row, "baseline_m", 0.05, 5.0);
    session.pose_lag = within(table, row, "pose_lag_s", 0.0, 2.0);
    session.pose_rate = within(table, row, "pose_rate_hz", 0.5, 200.0);
    session.imu_sign = within(table, row, "imu_sign_applied", -1.0, 1.0);
    session.absolute_attitude =
        table.text(row, table.column("roll_pitch")).rfind("absolute", 0) == 0;
    session.rows = static_cast<size_t>(table.integer(row, table.column("n_rows")));
    return session;
  }
  throw ImportError(sessions_path + ": no session " + name +
                    "; its radius and pose lag are needed (--session NAME names another row)");
}

}  // namespace tread::importer
