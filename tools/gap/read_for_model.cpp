// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/read_for_model.hpp"

#include <stdexcept>

#include "tools/gap/drive_log.hpp"
#include "tools/gap/import_note.hpp"

namespace tread::gap {

Drive readDriveFor(const ModelDocument& model, const std::string& path) {
  Drive drive = readDrive(path);
  requireSameGauge(drive, model.vehicle.gauge);
  if (drive.stretches.empty() || drive.kind == model.vehicle.kind) return drive;
  const bool power = drive.kind == CommandKind::kPower;
  throw std::runtime_error(path + ": its commands are " + (power ? "powers" : "track speeds") +
                           ", those of the model " + (power ? "track speeds" : "powers") +
                           "; give a model with kind: " + (power ? "power" : "track_speed"));
}

Drive readSoundDriveFor(const ModelDocument& model, const std::string& path) {
  Drive drive = readDriveFor(model, path);
  for (const HygieneNote& note : drive.notes)
    if (note.fatal) throw std::runtime_error(path + ": " + note.what);
  if (drive.executions.empty())
    throw std::runtime_error(path + ": nothing was driven for two seconds; give a log of a drive");
  return drive;
}

}  // namespace tread::gap
