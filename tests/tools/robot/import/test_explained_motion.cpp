// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// CSV drives with columns that differ from the mapping: each mistake is named by the checks that
// tread-import and tread-gap share.
#include <catch2/catch.hpp>

#include <cmath>
#include <functional>
#include <random>

#include "common/config/config_reader.hpp"
#include "common/soundness/drive_log.hpp"
#include "tests/tools/robot/import/drive_samples.hpp"
#include "tools/robot/import/csv_drive.hpp"

using namespace tread;
using namespace tread::import;
using tread::samples::Folder;
using tread::samples::line;

namespace {

/// Values of a row of the drive.
struct DriveRow {
  double t = 0.0, left = 0.0, right = 0.0, speed_left = 0.0, speed_right = 0.0;
  double x = 0.0, y = 0.0, yaw = 0.0, gyro = 0.0;
};

constexpr double kGauge = 0.6;  // [m]

/// A robot of two sides that slips in turns and follows its commands .2 s late, for five minutes.
std::vector<DriveRow> drivenRows() {
  std::mt19937_64 random(11);
  std::normal_distribution<double> noise;
  std::vector<DriveRow> rows;
  Pose2 T_map_body{3.0, -2.0, 0.4};
  double v = 0.0, omega = 0.0, turned = T_map_body.yaw;
  DriveRow row;
  for (int i = 0; i < 6000; ++i) {
    if (i % 50 == 0) {
      const double forward = static_cast<double>(random() % 1000) / 1000.0 - 0.2;
      const double turn = static_cast<double>(random() % 1000) / 800.0 - 0.625;
      row.left = forward - 0.5 * kGauge * turn;
      row.right = forward + 0.5 * kGauge * turn;
    }
    v += 0.22 * (0.95 * 0.5 * (row.left + row.right) - v);
    omega += 0.22 * (0.5 * (row.right - row.left) / kGauge - omega);
    T_map_body = T_map_body * integrate({v, 0.0, omega}, 0.05);
    turned += 0.05 * omega;
    row.t = 0.05 * i;
    row.speed_left = v / 0.95 - kGauge * omega + 0.01 * noise(random);
    row.speed_right = v / 0.95 + kGauge * omega + 0.01 * noise(random);
    row.x = T_map_body.x + 0.01 * noise(random);
    row.y = T_map_body.y + 0.01 * noise(random);
    row.yaw = wrapAngle(turned + 0.005 * noise(random));
    row.gyro = omega + 0.005 * noise(random);
    rows.push_back(row);
  }
  return rows;
}

struct Told {
  std::vector<std::string> lines, problems;
};

/// The log of such a drive; commands are missing if `given` is false, and poses, too, if `both`.
std::vector<LogEvent> logOf(
    const std::function<void(DriveRow&)>& change, const std::string& command = "unit: m/s",
    bool gyro = true, bool speeds = false,
    const std::function<bool(double)>& given = [](double) { return true; }, bool both = false) {
  static const std::vector<DriveRow> kRows = drivenRows();
  std::string commands = "t,l,r,sl,sr\n";
  std::string poses = "t,x,y,yaw,gyro\n";
  for (DriveRow row : kRows) {
    const double time = row.t;
    change(row);
    if (given(time))
      commands += line("%.3f,%.4f,%.4f,%.4f,%.4f\n", time, row.left, row.right, row.speed_left,
                       row.speed_right);
    if (given(time) || !both)
      poses += line("%.5f,%.5f,%.5f,%.6f,%.6f\n", row.t, row.x, row.y, row.yaw, row.gyro);
  }
  const std::string yaml =
      "baseline: 0.6\ntables:\n  - file: commands.csv\n    time: {column: t}\n    columns:\n"
      "      left_command: {column: l, " +
      command +
      "}\n"
      "      right_command: {column: r, " +
      command + "}\n" +
      (speeds ? "      left_speed: {column: sl}\n      right_speed: {column: sr}\n" : "") +
      "  - file: poses.csv\n    time: {column: t}\n"
      "    columns: {x: {column: x}, y: {column: y}, yaw: {column: yaw}" +
      (gyro ? ", yaw_rate: {column: gyro}" : "") + "}\n";
  const Folder folder("import_explained");
  folder.file("commands.csv", commands);
  folder.file("poses.csv", poses);
  ConfigReader reader = ConfigReader::fromText(yaml, "map.yaml");
  const CsvMapping mapping = readCsvMapping(reader);
  const ForeignDrive foreign = readMappedCsv(folder.file(""), mapping);
  recordings::Session session;
  session.pose_rate = 20.0;
  session.baseline = mapping.baseline;
  recordings::ImportCounts counts;
  return makeLog(foreign.drive, session, "csv", {}, counts);
}

/// Results of import and find for it.
Told told(const std::function<void(DriveRow&)>& change, const std::string& command = "unit: m/s",
          bool gyro = true, bool speeds = false) {
  Told result;
  const auto events = logOf(change, command, gyro, speeds);
  for (const gap::LogNote& note : gap::toDrive(toDriveLog("drive", events)).notes)
    if (note.isOfCommands()) (note.isFatal() ? result.problems : result.lines).push_back(note.what);
  return result;
}

/// The only problem.
std::string named(const std::function<void(DriveRow&)>& change,
                  const std::string& command = "unit: m/s", bool gyro = true, bool speeds = false) {
  const Told all = told(change, command, gyro, speeds);
  std::string text;
  for (const std::string& problem : all.problems) text += (text.empty() ? "" : " / ") + problem;
  return text;
}

using Catch::Contains;

}  // namespace

TEST_CASE("a drive that its commands explain is told in two lines: gains, correlation, delay") {
  for (const bool speeds : {false, true}) {
    const Told good = told([](DriveRow&) {}, "unit: m/s", true, speeds);
    CHECK(good.problems.empty());
    REQUIRE(good.lines.size() == 2);
    CHECK_THAT(good.lines[0], Contains("speed: measured is 0.9") && Contains("correlation 0.9"));
    CHECK_THAT(good.lines[0], Contains(" s after the commands"));
    CHECK_THAT(good.lines[1],
               Contains("turn: measured is 0.4") || Contains("turn: measured is 0.5"));
  }
  const auto by_power = [](DriveRow& row) {
    row.left *= 0.7;
    row.right *= 0.7;
  };
  const Told power = told(by_power, "unit: '1'");
  CHECK(power.problems.empty());
  CHECK_THAT(power.lines.at(0), Contains("m/s at full power"));
}

TEST_CASE("degrees taken for radians, and radians for degrees") {
  const double degree = kPi / 180.0;
  const auto in_degrees = [&](DriveRow& row) {
    row.yaw /= degree;
    row.gyro /= degree;
  };
  CHECK_THAT(named(in_degrees),
             Contains("are these degrees per second?") && Contains("are these degrees?"));
  CHECK_THAT(named([&](DriveRow& row) { row.yaw /= degree; }, "unit: m/s", false),
             Contains("degrees"));
  CHECK_THAT(named([&](DriveRow& row) { row.gyro /= degree; }), Contains("are these degrees per"));
  CHECK_THAT(named([&](DriveRow& row) { row.yaw *= degree; }),
             Contains("if that is in radians, but not in degrees"));
  CHECK_THAT(named([&](DriveRow& row) { row.gyro *= degree; }),
             Contains("is the gyro in rad/s, not in degrees per second?"));
}

TEST_CASE("sides in the wrong columns, with the wrong sign, and a body's speeds in their place") {
  const auto swap = [](DriveRow& row) { std::swap(row.left, row.right); };
  CHECK_THAT(named(swap), Contains("left and right are swapped"));
  const auto swapped_power = [&](DriveRow& row) {
    swap(row);
    row.left *= 0.5;
    row.right *= 0.5;
  };
  CHECK_THAT(named(swapped_power, "unit: '1'"), Contains("left and right are swapped"));
  const auto negative = [](DriveRow& row) {
    row.left = -row.left;
    row.right = -row.right;
  };
  CHECK_THAT(named(negative), Contains("both commands have the other sign"));
  CHECK_THAT(named([](DriveRow& row) { row.left = -row.left; }),
             Contains("the left side's command has the other sign"));
  CHECK_THAT(named([](DriveRow& row) { row.right = -row.right; }),
             Contains("the right side's command has the other sign"));
  const auto body = [](DriveRow& row) {
    const double v = 0.5 * (row.left + row.right);
    row.right = (row.right - row.left) / kGauge;
    row.left = v;
  };
  CHECK_THAT(named(body), Contains("speed and turn of the body"));
  CHECK_THAT(named([](DriveRow& row) { std::swap(row.speed_left, row.speed_right); }, "unit: m/s",
                   true, true),
             Contains("measured speeds of left and right are swapped"));
}

TEST_CASE("mirrored, swapped and turned axes") {
  CHECK_THAT(named([](DriveRow& row) { row.y = -row.y; }), Contains("y (or x) is inverted"));
  CHECK_THAT(named([](DriveRow& row) { row.x = -row.x; }), Contains("y (or x) is inverted"));
  CHECK_THAT(named([](DriveRow& row) { std::swap(row.x, row.y); }),
             Contains("x and y are swapped"));
  CHECK_THAT(named([](DriveRow& row) { row.yaw = -row.yaw; }),
             Contains("yaw counts clockwise (heading: {sense: clockwise})"));
  CHECK_THAT(named([](DriveRow& row) { row.yaw = wrapAngle(kPi / 2.0 - row.yaw); }),
             Contains("clockwise from north, as a compass does"));
  CHECK_THAT(named([](DriveRow& row) { row.yaw = wrapAngle(row.yaw - kPi / 2.0); }),
             Contains("degrees to the left of the heading all the time"));
  CHECK_THAT(named([](DriveRow& row) { row.yaw = wrapAngle(row.yaw + kPi); }),
             Contains("the heading is turned half round"));
  const auto down = [](DriveRow& row) {
    row.y = -row.y;
    row.yaw = -row.yaw;
    row.gyro = -row.gyro;
  };
  CHECK_THAT(named(down), Contains("z down"));
}

TEST_CASE("units of speeds and positions") {
  const auto kmh = [](DriveRow& row) {
    row.left *= 3.6;
    row.right *= 3.6;
  };
  CHECK_THAT(named(kmh), Contains("are the commands in km/h?"));
  const auto mm = [](DriveRow& row) {
    row.x *= 1000.0;
    row.y *= 1000.0;
  };
  CHECK_THAT(named(mm), Contains("no ground vehicle does: are these mm or cm"));
  const auto cm = [](DriveRow& row) {
    row.x *= 100.0;
    row.y *= 100.0;
  };
  CHECK_THAT(named(cm), Contains("cm"));
  const auto rpm = [](DriveRow& row) {
    row.left *= 30.0 / kPi;
    row.right *= 30.0 / kPi;
  };
  CHECK_THAT(named(rpm), Contains("revolutions a minute"));
}

TEST_CASE("commands and poses on two clocks are found with the offset, and clocks that drift") {
  const auto offset = [](double by) {
    const std::string text = named([&](DriveRow& row) { row.t += by; });
    INFO(text);
    REQUIRE_THAT(text, Contains("two clocks"));
    const double found = std::stod(text.substr(text.find("it comes ") + 9));
    return text.find(" s after them") != std::string::npos ? found : -found;
  };
  CHECK(offset(37.0) == Approx(37.2).margin(0.25));
  CHECK(offset(-18.0) == Approx(-17.8).margin(0.25));
  CHECK(offset(3600.0) == Approx(3600.2).margin(0.25));
  CHECK_THAT(named([](DriveRow& row) { row.t *= 1.003; }), Contains("drift"));
  for (const double late : {0.1, 0.5, 1.0})
    CHECK(named([&](DriveRow& row) { row.t += late; }) == "");
}

TEST_CASE("where commands are missing nothing is predicted, executed or measured by find") {
  // Six seconds of every fifty, as with radio dropouts.
  const auto given = [](double time) { return std::fmod(time, 50.0) < 43.9999; };
  const auto isHole = [](double begin, double end) {  // [s] since the first message
    return std::floor((end + 5.9) / 50.0) > std::floor((begin + 0.05) / 50.0);
  };
  // The poses are continuous, or missing together with the commands.
  const bool both = GENERATE(false, true);
  const auto events = logOf([](DriveRow&) {}, "unit: m/s", true, false, given, both);
  const gap::Drive drive = gap::toDrive(toDriveLog("drive", events));
  for (const gap::LogNote& note : drive.notes) CHECK_FALSE(note.isFatal());
  CHECK(drive.segments.size() == 6);
  CHECK(drive.driven() == Approx(6 * 44.0).margin(1.0));
  for (const gap::Segment& segment : drive.segments)
    CHECK_FALSE(isHole(segment.begin(), segment.end));
  REQUIRE(drive.executions.size() > 50);
  for (const gap::Execution& execution : drive.executions)
    CHECK_FALSE(isHole(execution.begin, execution.end));
  for (const motor_t& motor : samples::messagesOn(kMotor, events))
    CHECK(given(1e-6 * static_cast<double>(motor.utime) - 1.0));
  // The learner uses only completed executions.
  for (const execution_t& message : samples::messagesOn(kExecution, events))
    for (const execution_record_t& record : message.records)
      if (record.outcome == execution_record_t::OUTCOME_COMPLETED)
        CHECK_FALSE(isHole(1e-6 * static_cast<double>(record.started) - 1.0,
                           1e-6 * static_cast<double>(record.ended) - 1.0));
}
