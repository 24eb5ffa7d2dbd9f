// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Every command that writes a file, with each failure that the file can cause.

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "common/store/store.hpp"
#include "tests/common/recordings/synthetic_drives.hpp"
#include "tests/helpers.hpp"
#include "tests/tools/called_program.hpp"
#include "tests/tools/lab/experiment/crossing_runs.hpp"
#include "tests/tools/lab/experiment/drawn_driving.hpp"
#include "tests/tools/lab/experiment/small_world.hpp"
#include "tests/tools/lab/gap/arc_drive.hpp"
#include "tests/tools/programs.hpp"
#include "tests/tools/troubled_program.hpp"

namespace fs = std::filesystem;
using namespace tread;
using tread::samples::called;
using tread::samples::CalledProgram;
using tread::samples::Outcome;
using tread::samples::OwnFolder;
using tread::samples::runIn;
using tread::samples::Trouble;

namespace {

constexpr int kRefused = 2;
constexpr int kNotWritten = 1;

const std::string kConfig = std::string(TREAD_SOURCE_DIR) + "/config/";
/// A few seconds of the complete robot, to a near goal.
const std::string kShortMission =
    "tread-missions --goal 3 0 --simulator " + kConfig + "simulators/meadow.yaml";
const std::string kData = std::string(TREAD_SOURCE_DIR) + "/tests/data/";

/// A command that writes: IN and OUT are the paths of input and output, DIR is the folder of OUT, @
/// that of Inputs.
struct WritingCommand {
  std::string words;
  std::string input;  ///< a file or folder of Inputs, or of the source
  std::string output = "made";
  bool folder = false;  ///< it writes a folder
};

const std::vector<WritingCommand>& commands() {
  static const std::string kModel = kConfig + "models/warthog_nominal.yaml";
  static const std::string kTeodor = kConfig + "models/teodor_grass.yaml";
  static const std::string kSet = kConfig + "patterns/teodor.yaml";
  static const std::string kPlan =
      "tread-plan --patterns " + kSet + " --footprint 1.2,0.8 --map IN --deadline-ms 300 ";
  static const std::string kTask = kPlan + "--start 5,9,0 --goal 12,9,0 ";
  static const std::string kMission = kShortMission + " --faults IN ";
  static const std::vector<WritingCommand> all{
      {"tread-import --format mcap IN -o OUT", "drive.mcap"},
      {"tread-export --format mcap IN -o OUT", "drive.lcmlog"},
      {"tread-export --format csv IN -o OUT", "drive.lcmlog", "made", true},
      {"tread-why IN --html OUT", "drive.lcmlog"},
      {"tread-why IN --json OUT", "drive.lcmlog"},
      {"tread-report IN --rules none --picture OUT", "drive.lcmlog"},
      {"tread-overlay @/arcs.lcmlog --model IN --length 2 --picture OUT", kModel},
      {kTask + "--json OUT", kData + "planning/office.yaml"},
      {kTask + "--picture OUT", kData + "planning/office.yaml"},
      {kPlan + "--random 2 --write-queries OUT", kData + "planning/office.yaml"},
      {"tread-replay ins IN --report OUT", "track.nmea"},
      {"tread-replay ins IN --picture OUT", "track.nmea"},
      {"tread-replay mapping IN --report OUT", "drive.clf"},
      {"tread-replay mapping IN --picture OUT", "drive.clf"},
      {"tread-replay matching IN --report OUT", "drive.clf"},
      {"tread-replay matching IN --picture OUT", "drive.clf"},
      {"tread-replay planner IN --report OUT", "drive.lcmlog"},
      {"tread-replay learner IN --report OUT", "drive.lcmlog"},
      {"tread-replay learner @/drive.lcmlog --patterns IN --rule off --picture OUT", kSet},
      {"tread-replay learner @/drive.lcmlog --patterns IN --rule off --write-patterns OUT", kSet},
      {"tread-replay corpus IN --report OUT", "corpus"},
      {kMission + "--json OUT", "faults.yaml"},
      {kMission + "--log OUT", "faults.yaml"},
      {kMission + "--show 3 --picture OUT", "faults.yaml"},
      {"tread-gap find --model IN --train @/arcs.lcmlog --out OUT", kModel, "made", true},
      {"tread-gap repeat @/long.lcmlog @/longer.lcmlog --model IN --out OUT", kModel, "made", true},
      {"tread-gap plan track_asymmetry yaw_pull --model IN --out OUT", kModel},
      {"tread-gap what-if --model IN --add slip_ratio --out OUT", kModel, "made.html"},
      {"tread-patterns make IN --model " + kTeodor + " -o OUT",
       kConfig + "patterns/recipes/teodor.yaml"},
      {"tread-patterns recipe " + kConfig + "robots/teodor --model IN -o OUT", kTeodor},
      {"tread-patterns mirror IN -o OUT", kSet},
      {"tread-patterns show IN --picture OUT", kSet},
      {"tread-patterns average IN grass -o OUT", "recorded"},
      {"tread-patterns record IN --recordings DIR --surface made -n 3 --model " + kTeodor, kSet,
       "made.csv"},
      {"tread-patterns from-recordings IN -o OUT", "drives", "made", true},
      {"tread-experiment transitions --world IN --rules off,single --repetitions 20 --out OUT",
       "small.yaml", "made", true},
      {"tread-experiment adaptation --recordings IN --rules off --starts 3 --out OUT", "driving",
       "made", true},
      {"tread-experiment crossings --rules off --mapping " + samples::seamMapping() +
           " IN --out OUT",
       "runs.csv", "made", true},
      {"tread-compare-models --log IN --out OUT", "long.lcmlog", "made", true},
      {"tread-key new OUT", ""},
  };
  return all;
}

/// Inputs of the commands, created once.
class Inputs {
 public:
  Inputs() : drives_("writing_tools") {
    gap::samples::writeDrive(path("arcs.lcmlog"), 60.0);
    // A drive above 200 s is faster with fewer poses.
    gap::samples::writeDrive(path("long.lcmlog"), 205.0, 0.49, "", 16);
    gap::samples::writeDrive(path("longer.lcmlog"), 210.0, 0.49, "", 16);
    folder_.write("faults.yaml", "messages: []\n");
    folder_.write("small.yaml", experiment::testing::kSmallWorld);
    samples::writeRuns(path("runs.csv"), 2, 0.5);
    folder_.write("track.nmea", nmeaTrack());
    folder_.write("drive.clf", carmenDrive());
    run(kShortMission + " --log " + path("drive.lcmlog"));
    run("tread-export " + path("drive.lcmlog") + " -o " + path("drive.mcap"));
    fs::create_directories(path("corpus"));
    fs::copy_file(path("drive.lcmlog"), path("corpus/drive.lcmlog"));
    run("tread-patterns record " + kConfig + "patterns/teodor.yaml --model " + kConfig +
        "models/teodor_grass.yaml -n 4 --surface grass --recordings " + path("recorded"));
    writeDrives(drives_, {{"one", "Rover", "hard", samples::linearGround(0.95, 0.50, -0.05)},
                          {"two", "Rover", "soft", samples::linearGround(0.85, 0.43, -0.10)}});
    fs::copy(drives_.file(""), path("drives"), fs::copy_options::recursive);
    const samples::Folder driving("writing_tools_driving");
    adaptation::writeDriving(driving, {{"a", "grass"}, {"b", "sand"}, {"c", "gravel"}});
    fs::copy(driving.file(""), path("driving"), fs::copy_options::recursive);
  }

  std::string path(const std::string& name) const { return folder_.path(name); }

 private:
  static void run(const std::string& words) {
    const CalledProgram done = called(words);
    INFO(words << "\n" << done.printed);
    REQUIRE(done.status == 0);
  }

  /// A receiver that drives north.
  static std::string nmeaTrack() {
    std::string track;
    for (int i = 0; i < 20; ++i) {
      const int second = i;
      char text[120];
      std::snprintf(text, sizeof text,
                    "GPRMC,1200%02d.00,A,4900.%04d,N,00800.0000,E,2.0,0.0,241126,,,A", second,
                    10 * i);
      unsigned sum = 0;
      for (const char* c = text; *c != '\0'; ++c) sum ^= static_cast<unsigned char>(*c);
      char ending[8];
      std::snprintf(ending, sizeof ending, "*%02X\r\n", sum);
      track += std::string("$") + text + ending;
    }
    return track;
  }

  /// A robot that drives towards a wall, with a range finder.
  static std::string carmenDrive() {
    std::string log = "PARAM robot_length 0.47 1 host 1\n";
    for (int i = 0; i < 5; ++i) {
      const std::string x = std::to_string(i);
      log += "ODOM " + x + " 0 0 0 0 0 0 host 0\nFLASER 180";
      for (int beam = 0; beam < 180; ++beam) log += " " + std::to_string(12 - i);
      log += " " + x + " 0 0 " + x + " 0 0 0 host 0\n";
    }
    return log;
  }

  OwnFolder folder_;
  samples::Folder drives_;
};

using Content = std::map<std::string, std::string>;

/// All files of a folder, optionally without unfinished ones.
Content contentOf(const std::string& folder, bool with_unfinished) {
  Content content;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = fs::relative(entry.path(), folder).string();
    if (!with_unfinished && name.find(".unfinished") != std::string::npos) continue;
    content[name] = entry.is_directory() ? "a folder" : readText(entry.path().string());
  }
  return content;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
    text.replace(at, what.size(), by);
  return text;
}

/// A command with a separate folder that contains its input.
class Desk {
 public:
  Desk(const WritingCommand& command, const Inputs& inputs) : command_(command), inputs_(inputs) {
    fs::create_directories(folder_.path("closed"));
    if (command.input.empty()) return;
    const bool ours = command.input.front() != '/';
    const fs::path from = ours ? inputs.path(command.input) : command.input;
    in_ = folder_.path(from.filename().string());
    fs::copy(from, in_, fs::copy_options::recursive);
    // A map's picture is in the same folder.
    if (from.filename() == "office.yaml")
      fs::copy_file(from.parent_path() / "office.pgm", folder_.path("office.pgm"));
  }
  ~Desk() { fs::permissions(folder_.path("closed"), fs::perms::owner_all); }
  Desk(const Desk&) = delete;
  Desk& operator=(const Desk&) = delete;

  std::string out() const { return folder_.path(command_.output); }
  std::string in() const { return in_; }
  std::string closed() const {
    fs::permissions(folder_.path("closed"), fs::perms::owner_read | fs::perms::owner_exec);
    return folder_.path("closed/" + command_.output);
  }
  Content content(bool with_unfinished = true) const {
    return contentOf(folder_.path(""), with_unfinished);
  }
  Outcome run(const std::string& out, Trouble trouble, const std::string& more = "") const {
    std::string words = replaced(command_.words, "@", fs::path(inputs_.path("x")).parent_path());
    words = replaced(replaced(words, " IN", " " + in_), "OUT", out);
    return runIn(folder_.path(""), replaced(words, "DIR", fs::path(out).parent_path()) + more,
                 trouble);
  }

 private:
  const WritingCommand& command_;
  const Inputs& inputs_;
  OwnFolder folder_;
  std::string in_;
};

/// Runs a command that must be refused before it opens any file; returns its cell of the table.
std::string refused(const Desk& desk, const std::string& out, const std::string& words,
                    Trouble trouble, const std::string& more = "") {
  const Content before = desk.content();
  const Outcome outcome = desk.run(out, trouble, more);
  INFO(outcome.complaint);
  CHECK(outcome.status == kRefused);
  CHECK(outcome.isOneLine());
  CHECK_THAT(outcome.complaint, Catch::Contains(words));
  CHECK((desk.content() == before));
  return outcome.status == kRefused && desk.content() == before ? "refused" : "LOST";
}

/// A command that fails while it overwrites a file.
std::string failed(const Desk& desk, Trouble trouble) {
  const Content before = desk.content();
  const Outcome outcome = desk.run(desk.out(), trouble, " --force");
  INFO(outcome.complaint);
  const bool killed = trouble == Trouble::kKilled;
  if (killed)
    CHECK(outcome.signal == SIGXFSZ);
  else
    CHECK((outcome.status == kNotWritten && outcome.isOneLine()));
  CHECK((desk.content(!killed) == before));
  return desk.content(!killed) == before ? killed ? "old whole" : "told, old whole" : "LOST";
}

/// The output is the input: by name, or a file in it, or its folder.
std::string inputAsOutput(const WritingCommand& command, const std::string& in) {
  if (command.folder) return fs::path(in).parent_path();
  if (!fs::is_directory(in)) return in;
  return fs::directory_iterator(in)->path();
}

using Row = std::vector<std::string>;

Row rowOf(const WritingCommand& command, const Inputs& inputs) {
  CAPTURE(command.words);
  const bool never_replaces = command.words.rfind("tread-key", 0) == 0;
  const bool names_output = command.words.find("OUT") != std::string::npos;
  const Desk desk(command, inputs);
  Row row(5, "has none");
  row[0] = desk.run(desk.out(), Trouble::kNone).complaint;
  INFO(row[0]);
  CHECK(fs::exists(desk.out()));
  if (!fs::exists(desk.out())) return row;
  if (names_output && !command.input.empty())
    for (const std::string more : {"", " --force"})
      row[0] = refused(desk, inputAsOutput(command, desk.in()), "input", Trouble::kNone, more);
  row[1] = refused(desk, desk.out(), never_replaces ? "File exists" : "--force", Trouble::kNone);
  row[2] = refused(desk, desk.closed(), "ermission denied", Trouble::kUnwritable);
  if (never_replaces) return row;  // it creates a new file or none
  row[3] = failed(desk, Trouble::kFullDisk);
  row[4] = failed(desk, Trouble::kKilled);
  return row;
}

void print(const std::map<std::string, Row>& table) {
  std::printf("%-52s %-10s %-10s %-12s %-16s %s\n", "writes", "the input", "existing", "no rights",
              "full disk", "killed");
  for (const auto& [words, row] : table)
    std::printf("%-52.52s %-10s %-10s %-12s %-16s %s\n", words.c_str(), row[0].c_str(),
                row[1].c_str(), row[2].c_str(), row[3].c_str(), row[4].c_str());
}

/// The command without its paths: "tread-why --html".
std::string shortened(const std::string& words) {
  std::string kept;
  std::string option;
  for (std::istringstream rest(words); rest >> option;) {
    const bool path = option.find_first_of("/@.") != std::string::npos || option == "IN";
    if (!path) kept += (kept.empty() ? "" : " ") + option;
  }
  return kept;
}

}  // namespace

TEST_CASE("no command that writes loses anything: input, old output, no rights, full disk, kill") {
  // Every output is synced to disk; a real-time test running in parallel must not be delayed by
  // that.
  if (::access("/dev/shm", W_OK) == 0) ::setenv("TMPDIR", "/dev/shm", 1);
  const Inputs inputs;
  std::map<std::string, Row> table;
  for (const WritingCommand& command : commands())
    table[shortened(command.words)] = rowOf(command, inputs);
  CHECK(table.size() == commands().size());
  print(table);
}

TEST_CASE("the table has every command that takes --force") {
  for (const samples::Command& command : samples::allCommands()) {
    if (command.help.find("--force ") == std::string::npos) continue;
    CAPTURE(command.words);
    CHECK(std::any_of(commands().begin(), commands().end(), [&](const WritingCommand& row) {
      return row.words.rfind(command.words + " ", 0) == 0;
    }));
  }
}
