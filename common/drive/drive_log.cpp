// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/drive/drive_log.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>

#include <Eigen/Geometry>

#include "common/messages/blank.hpp"

namespace tread {
namespace {

constexpr size_t kRepeated = 8;  // executions in an EXECUTION message

/// Sorts the events of a log by type.
class Reader {
 public:
  explicit Reader(DriveLog& log) : log_(log) {}

  void take(const DriveEvent& event) {
    dispatch(
        event, [&](const auto& message) { take(message, event.recorded); }, kMotor, kIns,
        kExecution, kConfig, kMark);
  }

 private:
  template <class Message>
  static void addTimed(const Message& message, int64_t logged, std::vector<Message>& messages,
                       std::vector<Stamp>& stamps) {
    stamps.push_back({isPossibleTime(logged) ? logged : message.utime, message.utime, message.seq});
    messages.push_back(message);
  }
  void take(const motor_t& motor, int64_t logged) {
    addTimed(motor, logged, log_.motor, log_.motor_stamps);
  }
  void take(const ins_t& ins, int64_t logged) { addTimed(ins, logged, log_.ins, log_.ins_stamps); }
  void take(const execution_t& message, int64_t) {
    for (const execution_record_t& record : message.records)
      if (record.outcome != execution_record_t::OUTCOME_RUNNING && isPossibleTime(record.started) &&
          isPossibleTime(record.ended) && ended_.insert(keyOf(record)).second)
        log_.executions.push_back(record);
  }
  void take(const config_t& config, int64_t) { log_.configs.push_back(config); }
  void take(const mark_t& mark, int64_t) {
    if (mark.mark_kind == "surface") log_.surfaces[mark.utime] = mark.mark_value;
  }

  DriveLog& log_;
  std::set<ExecutionKey> ended_;
};

}  // namespace

bool isPossibleTile(const map_tile_t& tile) {
  constexpr int32_t kMostCells = 1024, kFarthest = 1'000'000;  // per side; tiles from the origin
  return tile.tile_cells > 0 && tile.tile_cells <= kMostCells && tile.cell_size >= 0.01 &&
         tile.cell_size <= 10.0 && std::abs(tile.tile_x) < kFarthest &&
         std::abs(tile.tile_y) < kFarthest &&
         tile.cells.size() ==
             static_cast<size_t>(tile.tile_cells) * static_cast<size_t>(tile.tile_cells);
}

std::string DriveLog::surfaceAt(int64_t utime) const {
  const auto after = surfaces.upper_bound(utime);
  return after == surfaces.begin() ? "unknown" : std::prev(after)->second;
}

namespace {

DriveLog readDriveLog(const std::string& name, DriveReader events) {
  DriveLog log;
  log.name = name;
  Reader reader(log);
  for (DriveEvent event; events.next(event);) {
    reader.take(event);
    log.events.push_back(std::move(event));
  }
  log.problem = events.problem();
  log.damage = events.damage();
  log.notes = events.notes();
  return log;
}

}  // namespace

DriveLog toDriveLog(const std::string& name, std::vector<LogEvent> events) {
  return readDriveLog(name, DriveReader(std::move(events)));
}

DriveLog readDriveLog(const std::vector<std::string>& paths) {
  return readDriveLog(std::filesystem::path(paths.front()).filename().string(), DriveReader(paths));
}

void DriveLogBuilder::addMark(int64_t utime, const std::string& kind, const std::string& value) {
  auto mark = blank<mark_t>();
  mark.utime = utime;
  mark.mark_kind = kind;
  mark.mark_value = value;
  add(kMark, mark);
}

void DriveLogBuilder::addConfig(int64_t utime, const std::string& process, int64_t boot_id,
                                const std::string& text) {
  auto config = blank<config_t>();
  config.utime = utime;
  config.config_process = process;
  config.config_boot_id = boot_id;
  config.config_text = text;
  add(kConfig, config);
}

execution_record_t& DriveLogBuilder::start(const execution_record_t& record) {
  if (records_.size() == kRepeated) records_.erase(records_.begin());
  return records_.emplace_back(record);
}

void DriveLogBuilder::publishExecutions(int64_t utime) {
  auto message = blank<execution_t>();
  message.utime = utime;
  message.records = records_;
  message.num_records = static_cast<int32_t>(records_.size());
  add(kExecution, message);
}

std::vector<LogEvent> DriveLogBuilder::sorted() {
  std::stable_sort(events_.begin(), events_.end(),
                   [](const LogEvent& a, const LogEvent& b) { return a.utime < b.utime; });
  return std::move(events_);
}

void DriveLogBuilder::setAttitude(ins_t& ins, double yaw, double pitch, double roll) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  Eigen::Quaterniond q(AngleAxisd(yaw, Vector3d::UnitZ()));
  if (pitch != 0.0 || roll != 0.0)
    q = q * AngleAxisd(pitch, Vector3d::UnitY()) * AngleAxisd(roll, Vector3d::UnitX());
  ins.orientation[0] = q.w();
  ins.orientation[1] = q.x();
  ins.orientation[2] = q.y();
  ins.orientation[3] = q.z();
}

}  // namespace tread
