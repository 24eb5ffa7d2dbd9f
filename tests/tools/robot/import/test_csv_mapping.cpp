// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// CSV drives of other robots, imported with a mapping file. No recording of FoMo is included: the
// test writes a session with the files and columns of the data set's examples.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

#include "common/config/config_reader.hpp"
#include "common/geometry/se2.hpp"
#include "common/recordings/csv_table.hpp"
#include "tests/tools/called_program.hpp"
#include "tests/tools/robot/import/drive_samples.hpp"
#include "tools/robot/import/csv_drive.hpp"

using namespace tread;
using namespace tread::import;
using tread::samples::Folder;
using tread::samples::line;

namespace {

CsvMapping mappingOf(const std::string& yaml, const std::vector<std::string>& overrides = {}) {
  ConfigReader reader = ConfigReader::fromText(yaml, "map.yaml", overrides);
  return readCsvMapping(reader);
}

CsvMapping shipped(const std::string& name, const std::vector<std::string>& overrides = {}) {
  ConfigReader reader =
      ConfigReader::fromFile(std::string(TREAD_SOURCE_DIR) + "/config/imports/" + name, overrides);
  return readCsvMapping(reader);
}

ForeignDrive readText(const std::string& csv, const std::string& yaml) {
  const Folder folder("import_csv");
  return readMappedCsv(folder.file("drive.csv", csv), mappingOf(yaml));
}

/// The exception's text when reading, without the folder.
std::string complaint(const std::string& csv, const std::string& yaml) {
  try {
    readText(csv, yaml);
  } catch (const std::exception& error) {
    const std::string text = error.what();
    const size_t at = text.find("drive.csv");
    return at == std::string::npos ? text : text.substr(at);
  }
  return "nothing";
}

const std::string kPoses =
    "tables:\n"
    "  - time: {column: t, unit: ms}\n"
    "    columns: {x: {column: x}, y: {column: y}, yaw: {column: yaw}}\n";
const std::string kCommands =
    "tables:\n"
    "  - time: {rate: 10}\n"
    "    columns: {left_command: {column: l}, right_command: {column: r}}\n";

}  // namespace

TEST_CASE("the example mapping: units, scales, compass, degrees of latitude, power per side") {
  std::string csv =
      "time_ms,cmd_left,cmd_right,rpm_left,rpm_right,battery,amps_left,amps_right,lat,lon,alt,"
      "compass,gyro_z,roll,pitch\n";
  for (int i = 0; i < 100; ++i)
    csv += line("%d,40,-30,60,-60,24500,3.5,4.5,%.9f,7.5587,120,30,90,2,-1\n", 50 * i,
                50.3629 + i * 1e-6);
  const Folder folder("import_csv_example");
  const ForeignDrive read = readMappedCsv(folder.file("a.csv", csv), shipped("example.yaml"));
  const recordings::RecordedDrive& drive = read.drive;
  REQUIRE(read.left_out.empty());
  REQUIRE(drive.channels == trackChannels(CommandKind::kPower));
  REQUIRE(drive.drive.size() == 100);
  const recordings::DriveSample& sample = drive.drive[50];
  CHECK(sample.command[0] == Approx(0.4));
  CHECK(sample.command[1] == Approx(0.3));
  CHECK(sample.speed[0] == Approx(2.0 * kPi * 0.12));
  CHECK(sample.speed[1] == Approx(2.0 * kPi * 0.12));
  CHECK(sample.voltage == Approx(24.5));
  CHECK(sample.current[1] == Approx(4.5));
  REQUIRE(drive.fixes.size() == 100);
  const recordings::Fix& fix = drive.fixes.back();
  CHECK(fix.time == Approx(4.95));
  CHECK(fix.T_map_body.x == Approx(0.0).margin(1e-6));
  CHECK(fix.T_map_body.y == Approx(99e-6 * 111'240.0).epsilon(0.001));  // a degree there
  CHECK(fix.T_map_body.yaw == Approx(60.0 * kPi / 180.0));
  CHECK(fix.yaw_rate == Approx(kPi / 2.0));
  CHECK(fix.roll == Approx(2.0 * kPi / 180.0));
  REQUIRE(drive.runs.size() == 1);
}

TEST_CASE("columns by number, other delimiters, quaternions and a named origin") {
  const ForeignDrive read = readText(
      "1.5; 1010; 2020; 0.7071068; 0; 0; 0.7071068\n2.0; 1011; 2020; 0.7071068; 0; 0; 0.7071068\n",
      "origin: {at: [1000, 2000, 0]}\n"
      "tables:\n"
      "  - delimiter: semicolon\n"
      "    header: false\n"
      "    time: {column: 1}\n"
      "    columns:\n"
      "      {x: {column: 2}, y: {column: 3}, qw: {column: 4}, qx: {column: 5}, qy: {column: 6},\n"
      "       qz: {column: 7}}\n");
  REQUIRE(read.drive.fixes.size() == 2);
  CHECK(read.drive.fixes[1].time == Approx(0.5));
  CHECK(read.drive.fixes[1].T_map_body.x == Approx(11.0));
  CHECK(read.drive.fixes[1].T_map_body.y == Approx(20.0));
  CHECK(read.drive.fixes[1].T_map_body.yaw == Approx(kPi / 2.0));
  CHECK(read.drive.drive.empty());
}

TEST_CASE("fields that are empty or nan are no measurements, but the rest of their row is") {
  const ForeignDrive read = readText(
      "\xEF\xBB\xBFt,x,y,yaw\n0,1,2,0\n100,,,0\n200,-nan,2,0\n200,7,7,7\n300,2,2,0\n", kPoses);
  REQUIRE(read.drive.fixes.size() == 2);
  CHECK(read.drive.fixes[1].T_map_body.x == 2.0);
  size_t of_x = 0;
  for (const auto& [what, count] : read.left_out)
    if (what.find("no x") != std::string::npos) of_x = count;
  CHECK(of_x == 2);
  REQUIRE(read.losses.size() == 1);
  CHECK(read.losses[0].lost == 1.0);
  CHECK(read.losses[0].of == 5.0);
  CHECK(read.losses[0].what == "the same time as the one before");
  CHECK(readText("t,x,y,yaw\n0,1,2,0\n100,1,2,0\n100,1,2,0\n", kPoses).losses.empty());
}

TEST_CASE("a spreadsheet's table gives the drive that the plain one gives") {
  const std::string mapping =
      "tables:\n  - time: {column: t}\n"
      "    columns: {left_command: {column: l, unit: m/s}, right_command: {column: r, unit: m/s},\n"
      "              x: {column: x}, y: {column: y}, yaw: {column: yaw}}\n";
  std::string rows;
  for (int i = 0; i < 100; ++i)
    rows += line("%.3f,0.600,0.500,%.4f,0.0000,0.00000\n", 0.05 * i, 0.03 * (i + 1));
  std::string spreadsheet = "t,l,r,x,y,yaw\n" + rows;
  std::replace(spreadsheet.begin(), spreadsheet.end(), ',', ';');
  std::replace(spreadsheet.begin(), spreadsheet.end(), '.', ',');
  std::string trailing = "t,l,r,x,y,yaw\n" + rows;
  for (size_t at = trailing.find('\n', 14); at != std::string::npos;
       at = trailing.find('\n', at + 2))
    trailing.insert(at, ",");
  for (const std::string& csv :
       {"t,l,r,x,y,yaw\n" + rows, "\xEF\xBB\xBF" + spreadsheet, trailing,
        "t,l,r,x,y,yaw\ns,m/s,m/s,m,m,rad\n" + rows, "My logger\n# t,l,r,x,y,yaw\n" + rows}) {
    const ForeignDrive read = readText(csv, mapping);
    CAPTURE(csv.substr(0, 60));
    REQUIRE(read.drive.fixes.size() == 100);
    CHECK(read.drive.fixes.back().time == Approx(4.95));
    CHECK(read.drive.fixes.back().T_map_body.x == Approx(3.0));
    CHECK(read.drive.drive.at(50).command[0] == Approx(0.6));
    CHECK(read.drive.drive.at(50).command[1] == Approx(0.5));
    const bool units = csv.find("m/s") != std::string::npos;
    CHECK(read.left_out.size() == (units ? 1 : 0));
    if (units)
      CHECK_THAT(read.left_out.begin()->first,
                 Catch::EndsWith("drive.csv: units below the header: s, m/s, m/s, m, m, rad"));
  }
}

TEST_CASE("a decimal comma that might be one of thousands is read by option only") {
  const std::string csv = "t;x;y;yaw\n0;1,500;2,000;1\n50;1,625;2,000;1\n";
  CHECK_THAT(complaint(csv, kPoses), Catch::Contains("column x is '1,500'; a decimal comma needs"));
  std::string mapping = kPoses;
  mapping.replace(mapping.find("- time"), 2, "- decimal_comma: true\n    ");
  CHECK(readText(csv, mapping).drive.fixes.at(1).T_map_body.x == 1.625);
  const Folder folder("import_decimal_comma");
  const std::string log = folder.file("a.lcmlog");
  const auto run = tread::samples::called("tread-import --format csv --decimal-comma --mapping " +
                                          folder.file("map.yaml", kPoses) + " " +
                                          folder.file("a.csv", csv) + " -o " + log);
  CHECK(run.status == 0);
  CHECK_THAT(run.printed, Catch::Contains("2 INS"));
}

TEST_CASE("a unit below the header that is not the mapping's is named") {
  CHECK(complaint("t,x,y,yaw\nms,m,m,deg\n0,1,2,90\n", kPoses) ==
        "drive.csv:1: column yaw is in deg in the row below the header, but not in the mapping; "
        "correct the unit of the column there");
  CHECK_THAT(complaint("t,x,y,yaw\n[s],m,m,rad\n0,1,2,1\n", kPoses),
             Catch::Contains("column t is in s in the row"));
  std::string scaled = kPoses;
  scaled.replace(scaled.find("{column: yaw}"), 13, "{column: yaw, scale: 0.0174532925}");
  const ForeignDrive read = readText("t,x,y,yaw\nms,m,m,deg\n0,1,2,90\n", scaled);
  CHECK(read.drive.fixes.at(0).T_map_body.yaw == Approx(kPi / 2.0));
}

TEST_CASE("times and places whose last digits a spreadsheet took away are named") {
  CHECK(complaint("t,x,y,yaw\n1.76414E+12,1,2,0\n1.76414E+12,1.1,2,0\n", kPoses) ==
        "drive.csv:2: column t is 1.76414E+12: in all rows a spreadsheet or program has rounded "
        "it, to 10000 s; export it as numbers with all their digits");
  // Steps of 1e7 ms would come once in ten thousand seconds only.
  CHECK_THAT(
      complaint("t,x,y,yaw\n1.76414E+12,1,2,0\n1.76414E+12,1,2,0\n1.76415E+12,1,2,0\n", kPoses),
      Catch::Contains("has rounded it, to 10000 s"));
  CHECK_THAT(complaint("t,x,y,yaw\n0,1,5.24273E+06,0\n50,1,5.24273E+06,0\n",
                       "origin: {first_fix: true}\n" + kPoses),
             Catch::Contains("column y is 5.24273E+06: in all rows a spreadsheet or program has "
                             "rounded it, to 10 m"));
  CHECK(readText("t,x,y,yaw\n1.764140000000E+12,1,2,0\n1.764140000050E+12,1,2,0\n", kPoses)
            .drive.fixes.size() == 2);
  CHECK(readText("t,x,y,yaw\n1E+03,1E+00,2E-05,0\n2E+03,1E+00,2,0\n", kPoses).drive.fixes.size() ==
        2);
}

TEST_CASE("refusals name file, line and column") {
  CHECK(complaint("t,x,y,yaw\n0,1,2,0\n100,abc,2,0\n", kPoses) ==
        "drive.csv:3: column x is 'abc'; a finite number is needed");
  CHECK(complaint("t,x,y,yaw\n0,1,2,0\n100,1e10,2,0\n", kPoses) ==
        "drive.csv:3: column x (x) is 1e+10 after unit and scale; allowed is up to 1e+05");
  CHECK(complaint("t,x,y,yaw\n0,1,2,0\n-300,1,2,0\n", kPoses) ==
        "drive.csv:3: column t goes back by 0.3 s; are these two drives? split the file there, or "
        "name the column that tells them apart (run:)");
  CHECK(complaint("t,x,y,yaw\n0,1,2,0\n1e12,1,2,0\n", kPoses) ==
        "drive.csv:3: column t is 1e+09 s after the first row; is the unit of the time right?");
  CHECK(complaint("t,x,z,yaw\n0,1,2,0\n", kPoses) ==
        "drive.csv:1: no column y; there are t, x, yaw, z");
  CHECK(complaint("t,x,y,yaw,x\n0,1,2,0,4\n", kPoses) ==
        "drive.csv:1: column x is there twice; give its number");
  CHECK(complaint("t,x,y,yaw\n0,1,2\n", kPoses) ==
        "drive.csv:2: 3 columns, the header has 4; is the file truncated?");
  CHECK(complaint("l,r\n0.5,0.5\n1.2,0.5\n", kCommands) ==
        "drive.csv:3: column l (left_command) is 1.2 after unit and scale; allowed is up to 1; is "
        "this per cent, or a speed?");
  CHECK(complaint("t,x,y,yaw\n0,1,2,0\n1,2e5,0,0\n", "origin: {first_fix: true}\n" + kPoses) ==
        "drive.csv:3: column of x: the position is 199999 m from the origin, beyond 100 km; give "
        "another origin in the mapping");
}

TEST_CASE("rows that overtake each other are sorted by their times") {
  const ForeignDrive read =
      readText("t,x,y,yaw\n0,0,2,0\n100,1,2,0\n300,3,2,0\n200,2,2,0\n", kPoses);
  REQUIRE(read.drive.fixes.size() == 4);
  for (size_t i = 0; i < 4; ++i) CHECK(read.drive.fixes[i].T_map_body.x == double(i));
  CHECK(read.losses.empty());
}

TEST_CASE(
    "a pose to which no vehicle goes is left out and named, an excursion is a track of its own") {
  const auto driven = [](const std::function<void(int, double&, double&)>& change) {
    std::string csv = "t,x,y,yaw\n";
    for (int i = 0; i < 300; ++i) {
      double x = 20.0 + 0.05 * i, y = 5.0;
      change(i, x, y);
      csv += line("%.1f,%.3f,%.3f,0\n", 50.0 * i, x, y);
    }
    return readText(csv, kPoses);
  };
  for (const double far : {99'999.0, 40.0, -40.0}) {
    const ForeignDrive spike = driven([&](int i, double& x, double&) { x = i == 100 ? far : x; });
    REQUIRE(spike.drive.fixes.size() == 299);
    REQUIRE(spike.losses.size() == 1);
    CHECK_THAT(lineOf(spike.losses[0]),
               Catch::Contains("1 of 300 poses") && Catch::Contains("drive.csv:102"));
    CHECK(spike.notes.empty());
    for (size_t i = 0; i < 299; ++i) CHECK(spike.drive.fixes[i].new_track == (i == 0));
  }

  const ForeignDrive zeros = driven([](int i, double& x, double& y) {
    if (i >= 100 && i < 110) x = y = 0.0;
  });
  REQUIRE(zeros.drive.fixes.size() == 300);
  CHECK(zeros.losses.empty());
  for (size_t i = 0; i < 300; ++i)
    CHECK(zeros.drive.fixes[i].new_track == (i == 0 || i == 100 || i == 110));
  REQUIRE(zeros.notes.size() == 1);
  CHECK_THAT(zeros.notes[0], Catch::Contains("2 times") && Catch::Contains("drive.csv:102"));

  // Metres instead of millimetres are no jumps: the comparison with the commands detects them.
  const ForeignDrive millimetres = driven([](int, double& x, double&) { x *= 1000.0; });
  CHECK(millimetres.drive.fixes.size() == 300);
  CHECK_THAT(millimetres.notes.at(0), Catch::Contains("299 of 300") && Catch::Contains("units"));
  for (size_t i = 0; i < 300; ++i) CHECK(millimetres.drive.fixes[i].new_track == (i == 0));
}

TEST_CASE("columns between bars are read, found or asked for") {
  const std::string csv = "t|x|y|yaw\n0|1|2|0\n50|1.1|2|0\n";
  CHECK(readText(csv, kPoses).drive.fixes.size() == 2);
  std::string asked = kPoses;
  asked.replace(asked.find("- time"), 2, "- delimiter: bar\n    ");
  CHECK(readText(csv, asked).drive.fixes.at(1).T_map_body.x == 1.1);
}

TEST_CASE("times in another unit than the mapping says are named with their unit") {
  const auto rows = [](double begin, double period) {
    std::string csv = "t,x,y,yaw\n";
    for (int i = 0; i < 20; ++i) csv += line("%.6f,1,2,0\n", begin + period * i);
    return csv;
  };
  const auto as = [](const std::string& unit) {
    std::string yaml = kPoses;
    return yaml.replace(yaml.find("ms"), 2, unit);
  };
  using Catch::Contains;
  CHECK_THAT(complaint(rows(1.7e18, 5e7), as("us")),
             Contains("in ns they would be 0.0500 s apart"));
  CHECK_THAT(complaint(rows(0, 5e7), as("s")), Contains("in ns they would"));
  CHECK_THAT(complaint(rows(3e9, 1e8), as("us")), Contains("in ns they would"));
  CHECK_THAT(complaint(rows(1.7e9, 0.05), as("ms")), Contains("in s they would"));
  CHECK_THAT(complaint(rows(1.7e12, 200), as("us")), Contains("in ms they would"));
  for (const auto& [unit, second] :
       {std::pair("s", 1.0), std::pair("ms", 1e3), std::pair("us", 1e6), std::pair("ns", 1e9)})
    for (const double period : {0.001, 0.01, 0.1, 1.0, 5.0})
      for (const double begin : {0.0, 100.0, 1e5, 1.7e9})
        CHECK(complaint(rows(begin * second, period * second), as(unit)) == "nothing");
}

TEST_CASE("between two commands that are further apart than their period allows nothing is known") {
  std::string csv = "t,l,r\n";
  for (int i = 0; i < 400; ++i)
    if (i < 100 || i >= 220) csv += line("%.2f,0.5,0.25\n", 0.05 * i);
  const std::string mapping =
      "tables:\n"
      "  - time: {column: t}\n"
      "    columns: {left_command: {column: l}, right_command: {column: r}}\n";
  const recordings::RecordedDrive drive = readText(csv, mapping).drive;
  REQUIRE(drive.drive.size() == 280);
  for (const recordings::DriveSample& sample : drive.drive) {
    CHECK(sample.automatic);
    CHECK(sample.command[0] == 0.5);
    CHECK((sample.time < 5.0 || sample.time > 10.99));
  }
  REQUIRE(drive.runs.size() == 2);
  recordings::ImportCounts counts;
  recordings::Session session;
  session.pose_rate = 10.0;
  const auto executions = [&](const recordings::ExecutionLayout& layout) {
    const auto events = recordings::makeLog(drive, session, "csv", layout, counts);
    return std::pair(counts.completed, counts.aborted);
  };
  CHECK(executions({1.0, 2.0, 2}) == std::pair<size_t, size_t>(4, 0));
  counts = {};
  CHECK(executions({1.0, 3.0, 2}) == std::pair<size_t, size_t>(3, 1));
  // If commands are written only on change, the mapping states how long they hold.
  CHECK(readText(csv, "command_hold: 10\n" + mapping).drive.drive.size() == 400);
}

TEST_CASE("a mapping that cannot mean a drive is refused with its line") {
  const auto refusal = [](const std::string& yaml) { return complaint("a\n1\n", yaml); };
  const auto columns = [](const std::string& text) {
    return "tables:\n  - time: {rate: 10}\n    columns: {" + text + "}\n";
  };
  using Catch::Contains;
  CHECK_THAT(refusal(columns("speed: {column: a}")),
             Contains("map.yaml:3") && Contains("known are"));
  CHECK_THAT(refusal(columns("left_command: {column: a}")), Contains("come together"));
  CHECK_THAT(refusal(columns("x: {column: a}, y: {column: a}")), Contains("needs one heading"));
  CHECK_THAT(refusal(columns("left_command: {column: a, unit: rpm}, right_command: {column: a}")),
             Contains("needs wheel_radius"));
  CHECK_THAT(refusal(columns("left_command: {column: a, unit: m/s}, right_command: {column: a}")),
             Contains("one side is power"));
  CHECK_THAT(refusal(columns("voltage: {column: a, unit: kV}")), Contains("V, mV"));
  CHECK_THAT(refusal("heading: {course_above: 0.5}\n" + columns("x: {column: a}, y: {column: a}")),
             Contains("drives backwards"));
  CHECK_THAT(refusal("tables:\n  - time: {}\n    columns: {voltage: {column: a}}\n"),
             Contains("map.yaml:2") && Contains("give one"));
  CHECK_THAT(refusal(kCommands + "  - time: {column: a}\n    columns: {voltage: {column: a}}\n"),
             Contains("cannot be combined"));
  CHECK_THAT(refusal("wheels: 4\n" + kCommands), Contains("wheels"));
}

namespace {

/// A session of FoMo: 3 s at rest, 6 s ahead to the east, 4 s back, at 1.5 m/s; a fix each 0.1 s.
void writeFomo(const Folder& folder) {
  const double begin = 1760456485.7;
  std::string poses, current, voltage;
  std::map<std::string, std::string> wheels;
  double x = 0.0;
  for (int i = 0; i < 130; ++i) {
    const double v = i < 30 ? 0.0 : i < 90 ? 1.5 : -1.5;
    const auto us = static_cast<long long>((begin + 0.1 * i) * 1e6);
    poses += line("%.9f %.9f 5242729.39 643.6 0 0 0 1\n", begin + 0.1 * i, 255855.356 + x);
    x += 0.1 * v;
    for (const char* name : {"cmd_velocity_left", "cmd_velocity_right"})
      wheels[name] += line("%lld,%.4f\n", us + (name[14] == 'l' ? 7000 : 0), v / 0.3);
    for (const char* name : {"velocity_left", "velocity_right"})
      wheels[name] += line("%lld,%.4f\n", us, v / 0.3);
    if (i % 10 == 0) current += line("%lld,%d\n", us, i), voltage += line("%lld,46.5\n", us);
  }
  std::filesystem::create_directories(folder.file("metadata"));
  folder.file("gt.txt", poses);
  for (const auto& [name, rows] : wheels)
    folder.file("metadata/" + name + ".csv", "timestamp,value\n" + rows);
  folder.file("metadata/voltage_left.csv", "timestamp,value\n" + voltage);
  for (const char* name : {"current_left", "current_right"})
    folder.file(std::string("metadata/") + name + ".csv", "timestamp,value\n" + current);
}

}  // namespace

TEST_CASE(
    "a session of FoMo by its shipped mapping: wheels per side, volts, amperes, RTK, course") {
  const Folder folder("import_fomo");
  writeFomo(folder);
  const ForeignDrive read = readMappedCsv(folder.file(""), shipped("fomo.yaml"));
  const recordings::RecordedDrive& drive = read.drive;
  REQUIRE(drive.channels == trackChannels(CommandKind::kTrackSpeed));
  CHECK(read.left_out.at("poses without a heading") < 35);
  REQUIRE(drive.fixes.size() > 90);
  // Ahead and back with the nose to the east.
  for (const recordings::Fix& fix : drive.fixes)
    CHECK(std::abs(wrapAngle(fix.T_map_body.yaw)) < 1e-6);
  CHECK(drive.fixes.front().T_map_body.x < 0.5);
  CHECK(drive.fixes.front().time == Approx(3.0).margin(0.15));
  CHECK(drive.drive.at(100).command[0] == Approx(1.5));
  CHECK(drive.drive.at(100).speed[1] == Approx(1.5));
  CHECK(drive.drive.at(100).voltage == Approx(46.5));
  CHECK(drive.drive.at(100).current[0] == Approx(50.0).margin(1.0));
  REQUIRE(drive.runs.size() == 2);
  CHECK(drive.runs[0].end - drive.runs[0].begin == Approx(6.0).margin(0.11));
  const ForeignDrive tracks =
      readMappedCsv(folder.file(""), shipped("fomo.yaml", {"wheel_radius=0.18"}));
  CHECK(tracks.drive.drive.at(100).command[0] == Approx(0.9));
  std::filesystem::remove(folder.file("metadata/current_right.csv"));
  CHECK_THROWS_WITH(readMappedCsv(folder.file(""), shipped("fomo.yaml")),
                    Catch::Contains("current_right.csv: cannot be read"));
}
