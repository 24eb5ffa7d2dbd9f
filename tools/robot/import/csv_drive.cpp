// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/import/csv_drive.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include "common/config/scalars.hpp"
#include "common/geometry/degrees.hpp"
#include "common/geometry/se3.hpp"
#include "common/log/unpacked_file.hpp"
#include "modules/ins_driver/core/ins_source.hpp"
#include "tools/robot/import/csv_check.hpp"

namespace tread::import {
namespace {

using recordings::CsvTable;
using recordings::DriveSample;
using recordings::Fix;
using recordings::kUnknown;
using recordings::RecordedDrive;
using recordings::RecordingError;

/// Speeds, voltages and rates expire after this age [s].
constexpr double kSpeedAge = 0.3;
constexpr double kBatteryAge = 3.0;
constexpr double kRateAge = 0.02;
/// Course over ground needs two fixes within this time [s].
constexpr double kCourseGap = 1.0;

/// Measurements of one column, ordered by time.
class Series {
 public:
  void add(double time, double value, size_t line) { samples_.push_back({time, value, line}); }
  void shift(double by) {
    for (Sample& sample : samples_) sample.time += by;
  }
  bool empty() const { return samples_.empty(); }
  size_t size() const { return samples_.size(); }
  double time(size_t i) const { return samples_[i].time; }
  size_t line(size_t i) const { return samples_[i].line; }
  /// Typical sampling period [s].
  double period() const {
    std::vector<double> times;
    for (const Sample& sample : samples_) times.push_back(sample.time);
    return usualPeriod(times);
  }
  /// The newest value at `time`, NaN if it is older than `age` [s].
  double at(double time, double age) const {
    const auto after =
        std::upper_bound(samples_.begin(), samples_.end(), time,
                         [](double t, const Sample& sample) { return t < sample.time; });
    if (after == samples_.begin() || time - std::prev(after)->time > age) return kUnknown;
    return std::prev(after)->value;
  }

 private:
  struct Sample {
    double time;
    double value;
    size_t line;  // of the file
  };
  std::vector<Sample> samples_;
};

/// A guess at the real unit of a value that no vehicle reaches.
std::string unitHint(const std::string& quantity, double limit) {
  if (quantity == "yaw_rate") return "; are these degrees per second?";
  const bool channel = quantity.find("_command") != std::string::npos ||
                       quantity.find("_speed") != std::string::npos;
  if (channel && limit == 1.0) return "; is this per cent, or a speed?";
  return channel && limit == 100.0 ? "; are these mm/s, or revolutions a minute?" : "";
}

/// All quantities of a recording.
class CsvContent {
 public:
  CsvContent(const std::string& path, const CsvMapping& mapping, ForeignDrive& result)
      : result_(result), silence_(recordings::kSilence + mapping.command_hold.value_or(0.0)) {
    const std::filesystem::path place(path);
    for (const CsvSource& source : mapping.sources) {
      const bool folder = std::filesystem::is_directory(place);
      if (folder && source.file.empty())
        throw RecordingError(path + ": is a folder; name the file of each table in the mapping");
      const std::filesystem::path parent = folder ? place : place.parent_path();
      read(source.file.empty() ? path : (parent / source.file).string(), source);
    }
    for (auto& [name, series] : series_) series.shift(-begin_);
    for (double& drive : drives_) drive -= begin_;
    for (recordings::TimedGround& ground : grounds_) ground.time -= begin_;
  }

  const Series& of(const std::string& quantity) const {
    static const Series kNone;
    const auto found = series_.find(quantity);
    return found == series_.end() ? kNone : found->second;
  }
  double at(const std::string& quantity, double time, double age) const {
    return of(quantity).at(time, age);
  }
  /// Surface names from the tables, each with its start time.
  const std::vector<recordings::TimedGround>& grounds() const { return grounds_; }
  /// Whether a drive ends between the two times.
  bool isApart(double time, double later) const {
    const auto next = std::upper_bound(drives_.begin(), drives_.end(), time);
    return next != drives_.end() && *next <= later;
  }
  /// "file:line" of a quantity's i-th measurement, for messages.
  std::string placeOf(const std::string& quantity, size_t i) const {
    return files_.at(quantity) + ":" + std::to_string(of(quantity).line(i));
  }

 private:
  /// A row with its time.
  struct Row {
    double time;
    size_t row;
  };

  void read(const std::string& file, const CsvSource& source) {
    const UnpackedFile unpacked(file);
    try {
      read(CsvTable(unpacked.path(), source.layout), file, source);
    } catch (const RecordingError& error) {
      throw RecordingError(unpacked.reasonOf(error.what()));
    }
    if (!unpacked.problem().empty()) result_.losses.push_back({unpacked.problem(), 0.0, 0.0, ""});
  }

  void read(const CsvTable& table, const std::string& file, const CsvSource& source) {
    for (const auto& [quantity, column] : source.columns) files_[quantity] = file;
    for (const std::string& words : table.units())
      ++result_.left_out[file + ": units below the header: " + words];
    checkTable(table, source);
    std::vector<Row> rows = rowsOf(table, file, source);
    const auto same = [&](const Row& a, const Row& b) {
      return std::all_of(source.columns.begin(), source.columns.end(), [&](const auto& column) {
        return table.text(a.row, column.second.column) == table.text(b.row, column.second.column);
      });
    };
    sortByTime(rows, "rows of " + file, same, result_);
    for (const Row& row : rows) {
      for (const auto& [quantity, column] : source.columns)
        take(table, row, quantity, column, file);
      takeGround(table, row, source);
    }
    if (!rows.empty()) begin_ = std::min(begin_, rows.front().time);
  }

  /// Rows in the order of the table, sorted by drive.
  std::vector<Row> rowsOf(const CsvTable& table, const std::string& file, const CsvSource& source) {
    std::vector<Row> rows;
    size_t others = 0;
    for (size_t row = 0; row < table.rows();) {
      const size_t first = row;
      std::vector<Row> drive;
      for (; row < table.rows() && isSameDrive(table, first, row, source); ++row) {
        if (isWanted(table, row, source))
          drive.push_back({timeOf(table, row, source), row});
        else
          ++others;
      }
      if (drive.empty()) continue;
      checkTimes(table, source, drive);
      if (!rows.empty()) follow(rows.back().time, drive);
      rows.insert(rows.end(), drive.begin(), drive.end());
    }
    if (others > 0) result_.left_out[file + ": rows excluded by the mapping (only:)"] += others;
    if (rows.empty() && others > 0)
      throw table.headerError("no row passes the mapping's filter (only:)");
    return rows;
  }

  /// Shifts a drive's times so that it follows the previous one after a silence.
  void follow(double last, std::vector<Row>& drive) {
    const double shift = last + silence_ - drive.front().time;
    for (Row& row : drive) row.time += shift;
    drives_.push_back(drive.front().time);
  }

  static bool isSameDrive(const CsvTable& table, size_t first, size_t row,
                          const CsvSource& source) {
    return source.run.empty() || table.text(row, source.run) == table.text(first, source.run);
  }

  static bool isWanted(const CsvTable& table, size_t row, const CsvSource& source) {
    constexpr double kSame = 1e-9;
    return std::all_of(source.only.begin(), source.only.end(), [&](const auto& only) {
      const double number = table.number(row, only.first);
      return std::any_of(only.second.begin(), only.second.end(),
                         [&](double wanted) { return std::abs(number - wanted) <= kSame; });
    });
  }

  /// Checks the times of one drive.
  static void checkTimes(const CsvTable& table, const CsvSource& source,
                         const std::vector<Row>& rows) {
    std::vector<double> raw;
    if (!source.time.empty())
      for (const Row& row : rows) raw.push_back(table.number(row.row, source.time));
    if (const auto problem = timeUnitProblem(raw, source.time_unit))
      throw table.error(rows.front().row,
                        "column " + source.time + ": " + *problem + ": give that unit");
    double newest = rows.front().time;
    for (const Row& row : rows) {
      const double since = row.time - rows.front().time;
      if (since > kLongest)
        throw table.error(row.row, "column " + source.time + " is " + formatNumber(since) +
                                       " s after the first row; is the unit of the time right?");
      if (row.time < newest - kOvertaking)
        throw table.error(row.row, "column " + source.time + " goes back by " +
                                       formatNumber(newest - row.time) +
                                       " s; are these two drives? split the file there, or name "
                                       "the column that tells them apart (run:)");
      newest = std::max(newest, row.time);
    }
  }

  static double timeOf(const CsvTable& table, size_t row, const CsvSource& source) {
    if (source.time.empty()) return static_cast<double>(row) / source.rate;
    return source.time_unit * table.number(row, source.time) + source.time_offset;
  }

  void take(const CsvTable& table, const Row& place, const std::string& quantity,
            const CsvColumn& column, const std::string& file) {
    const size_t row = place.row;
    if (table.missing(row, column.column)) {
      ++result_.left_out[file + ": no " + quantity];
      return;
    }
    const double value = column.factor * table.number(row, column.column);
    if (std::abs(value) > column.limit)
      throw table.error(row, "column " + column.column + " (" + quantity + ") is " +
                                 formatNumber(value) + " after unit and scale; allowed is up to " +
                                 formatNumber(column.limit) + unitHint(quantity, column.limit));
    series_[quantity].add(place.time, value, table.line(row));
  }

  /// "ice", or "ice/ice/gravel" if the wheels are on several surfaces.
  void takeGround(const CsvTable& table, const Row& row, const CsvSource& source) {
    if (source.ground.empty()) return;
    std::string name = table.text(row.row, source.ground.front()), of_all = name;
    bool one = true;
    for (size_t i = 1; i < source.ground.size(); ++i) {
      const std::string& other = table.text(row.row, source.ground[i]);
      one = one && other == name;
      of_all += "/" + other;
    }
    if (!one) name = of_all;
    if (grounds_.empty() || grounds_.back().name != name) grounds_.push_back({row.time, name});
  }

  ForeignDrive& result_;
  std::map<std::string, Series> series_;
  std::map<std::string, std::string> files_;
  std::vector<recordings::TimedGround> grounds_;
  double silence_;              ///< [s] between the drives of a table
  std::vector<double> drives_;  ///< [s] start times of the drives but the first
  double begin_ = std::numeric_limits<double>::max();
};

/// Transforms positions into the map frame.
class Placing {
 public:
  Placing(const CsvContent& content, const CsvMapping& mapping)
      : content_(content), mapping_(mapping), degrees_(mapping.has("latitude")) {
    if (mapping.origin) use(*mapping.origin);
  }

  /// p_map of the fix at this time; NaN where a coordinate is missing.
  Eigen::Vector3d at(double time) {
    const auto part = [&](const char* name) { return content_.at(name, time, 0.0); };
    const char* const up = degrees_ ? "height" : "z";
    Eigen::Vector3d place{part(degrees_ ? "latitude" : "x"), part(degrees_ ? "longitude" : "y"),
                          mapping_.has(up) ? part(up) : 0.0};
    if (!place.allFinite()) return place;
    if (!placed_ && (degrees_ || mapping_.origin_at_first_fix)) use(place);
    if (!degrees_) return place - origin_;
    return frame_->toMap({toRadians(place.x()), toRadians(place.y())}, place.z());
  }

 private:
  void use(const Eigen::Vector3d& place) {
    placed_ = true;
    origin_ = place;
    if (degrees_)
      frame_ = ins::LocalFrame({{toRadians(place.x()), toRadians(place.y())}, place.z(), 0.0});
  }

  const CsvContent& content_;
  const CsvMapping& mapping_;
  bool degrees_;
  bool placed_ = false;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  std::optional<ins::LocalFrame> frame_;
};

/// Sets the attitude of a fix from its columns; yaw is NaN if it was not measured.
void setAttitude(const CsvContent& content, const CsvMapping& mapping, Fix& fix) {
  const auto part = [&](const char* name) { return content.at(name, fix.time, 0.0); };
  if (mapping.has("qw")) {
    Eigen::Quaterniond q(part("qw"), part("qx"), part("qy"), part("qz"));
    fix.T_map_body.yaw = kUnknown;
    if (!(std::abs(q.norm() - 1.0) < 0.01)) return;
    const YawPitchRoll angles = yawPitchRoll(q.normalized());
    fix.T_map_body.yaw = angles.yaw + mapping.yaw_zero;
    fix.pitch = angles.pitch;
    fix.roll = angles.roll;
    return;
  }
  fix.T_map_body.yaw = mapping.yaw_zero + mapping.yaw_sense * part("yaw");
  fix.roll = part("roll");
  fix.pitch = part("pitch");
}

/// Heading as course over ground between the neighbouring fixes; NaN at low speed.
double courseAt(const std::vector<Fix>& fixes, size_t i, const CsvContent& content,
                double course_above) {
  const bool ends = i + 1 == fixes.size() || fixes[i + 1].new_track;
  const Fix& before = fixes[fixes[i].new_track ? i : i - 1];
  const Fix& after = fixes[ends ? i : i + 1];
  const Eigen::Vector2d way = after.T_map_body.position() - before.T_map_body.position();
  const double time = after.time - before.time;
  if (time <= 0.0 || time > kCourseGap || way.norm() / time < course_above) return kUnknown;
  const bool measured = !content.of("left_speed").empty();
  const double age = measured ? kSpeedAge : kCommandAge;
  const double ahead = content.at(measured ? "left_speed" : "left_command", fixes[i].time, age) +
                       content.at(measured ? "right_speed" : "right_command", fixes[i].time, age);
  if (!(std::abs(ahead) > 0.0)) return kUnknown;
  return std::atan2(way.y(), way.x()) + (ahead < 0.0 ? kPi : 0.0);
}

void takePoses(const CsvContent& content, const CsvMapping& mapping, ForeignDrive& result) {
  const char* const along = mapping.has("latitude") ? "latitude" : "x";
  const Series& times = content.of(along);
  Placing placing(content, mapping);
  std::vector<Fix> fixes;
  std::vector<size_t> measured;  // fixes with a measured position
  for (size_t i = 0; i < times.size(); ++i) {
    Fix fix;
    fix.time = times.time(i);
    const Eigen::Vector3d p_map = placing.at(fix.time);
    if (!p_map.allFinite()) continue;
    if (content.at("pose_new", fix.time, 0.0) == 0.0) {
      ++result.left_out["poses that repeat the one before (pose_new: 0)"];
      continue;
    }
    if (p_map.head<2>().norm() > kFarthest)
      throw RecordingError(content.placeOf(along, i) + ": column of " + along +
                           ": the position is " + formatNumber(std::round(p_map.head<2>().norm())) +
                           " m from the origin, beyond 100 km; give another origin in the mapping");
    fix.T_map_body = {p_map.x(), p_map.y(), 0.0};
    fix.z = p_map.z();
    if (!mapping.course_above) setAttitude(content, mapping, fix);
    fix.yaw_rate = content.at("yaw_rate", fix.time, kRateAge);
    fix.new_track = fixes.empty() || content.isApart(fixes.back().time, fix.time);
    fixes.push_back(fix);
    measured.push_back(i);
  }
  takeJumpsOut(
      fixes, [&](size_t i) { return content.placeOf(along, measured[i]); }, result);
  bool new_track = false;
  for (size_t i = 0; i < fixes.size(); ++i) {
    Fix fix = fixes[i];
    new_track = new_track || fix.new_track;
    if (mapping.course_above)
      fix.T_map_body.yaw = courseAt(fixes, i, content, *mapping.course_above);
    if (!std::isfinite(fix.T_map_body.yaw)) {
      ++result.left_out["poses without a heading"];
      continue;
    }
    fix.new_track = std::exchange(new_track, false);
    result.drive.fixes.push_back(fix);
  }
}

/// Values of all channels' columns of one kind ("speed", ...) at a time, no older than `age` [s].
Command channelsAt(const CsvContent& content, const CommandChannels& channels, const char* what,
                   double time, double age) {
  Command values;
  for (size_t c = 0; c < channels.size(); ++c)
    values[c] = content.at(channels[c].name + "_" + what, time, age);
  return values;
}

/// One sample for each time at which a channel got a new command.
std::vector<DriveSample> commandsOf(const CsvContent& content, const CommandChannels& channels,
                                    double hold) {
  std::vector<double> times;
  for (const CommandChannel& channel : channels) {
    const Series& series = content.of(channel.name + "_command");
    for (size_t i = 0; i < series.size(); ++i) times.push_back(series.time(i));
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  std::vector<DriveSample> commands;
  for (const double time : times) {
    DriveSample sample;
    sample.time = time;
    sample.command = channelsAt(content, channels, "command", time, hold);
    bool whole = true;
    for (size_t c = 0; c < channels.size(); ++c) whole = whole && std::isfinite(sample.command[c]);
    if (whole) commands.push_back(sample);
  }
  return commands;
}

void takeCommands(const CsvContent& content, const CsvMapping& mapping, RecordedDrive& drive) {
  // A log without commands gets the channels of a tracked vehicle.
  if (!mapping.channels.empty()) drive.channels = mapping.channels;
  const CommandChannels& channels = drive.channels;
  const double period = content.of(channels.front().name + "_command").period();
  const double hold = mapping.command_hold.value_or(holdOf(period));
  holdCommands(commandsOf(content, channels, hold), period, hold, drive);
  for (size_t i = 0; i < drive.drive.size(); ++i) {
    DriveSample& sample = drive.drive[i];
    sample.apart = i > 0 && content.isApart(drive.drive[i - 1].time, sample.time);
    sample.speed = channelsAt(content, channels, "speed", sample.time, kSpeedAge);
    sample.voltage = content.at("voltage", sample.time, kBatteryAge);
    sample.current = channelsAt(content, channels, "current", sample.time, kBatteryAge);
  }
  findRuns(drive);
}

}  // namespace

ForeignDrive readMappedCsv(const std::string& path, const CsvMapping& mapping) {
  ForeignDrive result;
  const CsvContent content(path, mapping, result);
  if (mapping.course_above)
    result.poses = "headings are the course over ground: they do not show sideslip";
  takePoses(content, mapping, result);
  takeCommands(content, mapping, result.drive);
  result.drive.grounds = content.grounds();
  if (result.drive.fixes.empty() && result.drive.drive.empty())
    throw RecordingError(path + ": holds neither a pose nor a command that can be used");
  return result;
}

}  // namespace tread::import
