// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/import/csv_mapping.hpp"

#include <algorithm>

#include "common/config/scalars.hpp"
#include "common/geometry/degrees.hpp"
#include "tools/robot/import/foreign_drive.hpp"

namespace tread::import {
namespace {

/// Allowed units of a column with their factors; the first is the default.
struct Unit {
  std::string name;
  double factor;
};

/// A quantity that a column may hold.
struct Quantity {
  std::vector<Unit> units;
  double limit;
};

const std::map<std::string, Quantity>& quantities() {
  // UTM northings are up to 10 000 km; they need an origin.
  static const Quantity kLength{{{"m", 1.0}, {"mm", 0.001}, {"cm", 0.01}}, 1.1e7};
  static const Quantity kAngle{{{"rad", 1.0}, {"deg", toRadians(1.0)}}, 10'000.0};
  static const Quantity kOne{{{"1", 1.0}}, 1.001};
  static const std::map<std::string, Quantity> kAll{
      {"voltage", {{{"V", 1.0}, {"mV", 0.001}}, 1000.0}},
      {"x", kLength},
      {"y", kLength},
      {"z", kLength},
      {"latitude", {{{"deg", 1.0}, {"rad", toDegrees(1.0)}}, 90.0}},
      {"longitude", {{{"deg", 1.0}, {"rad", toDegrees(1.0)}}, 360.0}},
      {"height", kLength},
      {"yaw", kAngle},
      {"roll", kAngle},
      {"pitch", kAngle},
      {"yaw_rate", {{{"rad/s", 1.0}, {"deg/s", toRadians(1.0)}}, 100.0}},
      {"qw", kOne},
      {"qx", kOne},
      {"qy", kOne},
      {"qz", kOne},
      {"pose_new", kOne}};
  return kAll;
}

const std::string kCommandOf = "_command";

/// The name without its ending; nullopt if the ending is another one or the rest is empty.
std::optional<std::string> channelBefore(const std::string& name, const std::string& ending) {
  if (name.size() <= ending.size() ||
      name.compare(name.size() - ending.size(), ending.size(), ending) != 0)
    return std::nullopt;
  return name.substr(0, name.size() - ending.size());
}

bool isSide(const std::string& channel) {
  return channel == "left" || channel == "right";
}

/// Quantity of a name: that of a command channel by its ending, else from quantities().
std::optional<Quantity> quantityNamed(const std::string& name) {
  const Quantity speed{{{"m/s", 1.0}, {"rad/s", 1.0}, {"rpm", 2.0 * kPi / 60.0}}, 100.0};
  const auto found = quantities().find(name);
  if (found != quantities().end()) return found->second;
  if (channelBefore(name, "_speed")) return speed;
  if (channelBefore(name, "_current")) return Quantity{{{"A", 1.0}, {"mA", 0.001}}, 10'000.0};
  const std::optional<std::string> channel = channelBefore(name, kCommandOf);
  if (!channel) return std::nullopt;
  Quantity command{{{"1", 1.0}, {"percent", 0.01}}, 1.0};
  command.units.insert(command.units.end(), speed.units.begin(), speed.units.end());
  if (!isSide(*channel)) {
    command.units.push_back({"rad", 1.0});
    command.units.push_back({"deg", toRadians(1.0)});
  }
  return command;
}

/// Kind of command for a unit.
CommandKind kindIn(const std::string& unit) {
  if (unit == "rad" || unit == "deg") return CommandKind::kSteeringAngle;
  return unit == "1" || unit == "percent" ? CommandKind::kPower : CommandKind::kTrackSpeed;
}

std::vector<std::string> namesOf(const std::vector<Unit>& units) {
  std::vector<std::string> names;
  for (const Unit& unit : units) names.push_back(unit.name);
  return names;
}

double factorOf(const std::vector<Unit>& units, const std::string& name) {
  return std::find_if(units.begin(), units.end(), [&](const Unit& u) { return u.name == name; })
      ->factor;
}

std::vector<std::string> otherUnits(const std::vector<Unit>& units, const std::string& name) {
  std::vector<std::string> others = namesOf(units);
  others.erase(std::remove(others.begin(), others.end(), name), others.end());
  return others;
}

bool turnsWheels(const std::string& unit) {
  return unit == "rad/s" || unit == "rpm";
}

class MappingReader {
 public:
  explicit MappingReader(ConfigReader& reader) : reader_(reader) {}

  CsvMapping read() {
    reader_.text("robot", mapping_.robot);
    reader_.text("surface", mapping_.surface);
    reader_.number("baseline", mapping_.baseline, {0.0, 10.0}, "m");
    reader_.number("wheel_radius", wheel_radius_, {0.001, 5.0}, "m");
    if (reader_.has("command_hold"))
      reader_.number("command_hold", mapping_.command_hold.emplace(), {0.05, 3600.0}, "s");
    readOrigin(reader_.section("origin"));
    readHeading(reader_.section("heading"));
    for (ConfigReader& table : reader_.sections("tables", true))
      mapping_.sources.push_back(readSource(table));
    reader_.finish();
    orderChannels();
    check();
    if (!mapping_.origin && !mapping_.origin_at_first_fix)
      for (CsvSource& source : mapping_.sources)
        for (const char* name : {"x", "y"})
          if (source.columns.count(name) != 0) source.columns[name].limit = kFarthest;
    return std::move(mapping_);
  }

 private:
  void readOrigin(ConfigReader origin) {
    origin.flag("first_fix", mapping_.origin_at_first_fix);
    std::vector<double> at;
    origin.numbers("at", at, 3, {-1.1e7, 1.1e7}, "m m m, or deg deg m");
    if (!at.empty()) mapping_.origin = Eigen::Vector3d(at[0], at[1], at[2]);
    if (mapping_.origin && mapping_.origin_at_first_fix)
      throw origin.error("at", "the origin is already set to the first fix; give one of them");
  }

  void readHeading(ConfigReader heading) {
    std::string sense = "counter_clockwise";
    heading.choice("sense", sense, {"counter_clockwise", "clockwise"});
    mapping_.yaw_sense = sense == "clockwise" ? -1.0 : 1.0;
    double zero = 0.0;
    heading.number("zero", zero, {-360.0, 360.0}, "deg");
    mapping_.yaw_zero = toRadians(zero);
    if (!heading.has("course_above")) return;
    mapping_.course_above = 0.5;
    heading.number("course_above", *mapping_.course_above, {0.05, 10.0}, "m/s");
  }

  CsvSource readSource(ConfigReader& table) {
    CsvSource source;
    table.text("file", source.file);
    static const std::map<std::string, char> kDelimiters{{"auto", '\0'}, {"bar", '|'},
                                                         {"comma", ','}, {"semicolon", ';'},
                                                         {"space", ' '}, {"tab", '\t'}};
    std::string delimiter = "auto";
    table.choice("delimiter", delimiter, {"auto", "bar", "comma", "semicolon", "space", "tab"});
    source.layout.delimiter = kDelimiters.at(delimiter);
    table.flag("header", source.layout.header);
    table.flag("decimal_comma", source.layout.decimal_comma);
    readTime(table.section("time", true), source);
    table.text("run", source.run);
    table.texts("ground", source.ground);
    ConfigReader only = table.section("only");
    for (const std::string& column : only.keys())
      only.numbers(column, source.only[column], 0, {-1e15, 1e15}, "as in the column");
    ConfigReader columns = table.section("columns", true);
    for (const std::string& quantity : columns.keys()) {
      if (!quantityNamed(quantity)) {
        std::vector<std::string> known{"NAME_command", "NAME_speed", "NAME_current"};
        for (const auto& [name, what] : quantities()) known.push_back(name);
        throw columns.error(quantity, "is not a quantity; known are " + joinWords(known));
      }
      if (mapping_.has(quantity)) throw columns.error(quantity, "is in another table, too");
      source.columns[quantity] = readColumn(columns.section(quantity), quantity);
    }
    if (source.columns.empty()) throw table.error("columns", "names no column");
    nameColumns(source);
    return source;
  }

  /// The header row is recognized by these columns.
  static void nameColumns(CsvSource& source) {
    std::vector<std::string>& names = source.layout.columns;
    if (!source.time.empty()) names.push_back(source.time);
    if (!source.run.empty()) names.push_back(source.run);
    names.insert(names.end(), source.ground.begin(), source.ground.end());
    for (const auto& [column, numbers] : source.only) names.push_back(column);
    for (const auto& [quantity, column] : source.columns) names.push_back(column.column);
    const auto is_number = [](const std::string& name) { return parseInteger(name).has_value(); };
    names.erase(std::remove_if(names.begin(), names.end(), is_number), names.end());
  }

  static void readTime(ConfigReader time, CsvSource& source) {
    static const std::vector<Unit> kUnits{{"s", 1.0}, {"ms", 1e-3}, {"us", 1e-6}, {"ns", 1e-9}};
    time.text("column", source.time);
    std::string unit = "s";
    time.choice("unit", unit, namesOf(kUnits));
    source.time_unit = factorOf(kUnits, unit);
    source.other_time_units = otherUnits(kUnits, unit);
    time.number("offset", source.time_offset, {-1e10, 1e10}, "s");
    time.number("rate", source.rate, {0.01, 10'000.0}, "Hz");
    if (source.time.empty() == (source.rate == 0.0))
      throw time.error("column", "a time is either a column with its unit, or a rate; give one");
  }

  CsvColumn readColumn(ConfigReader section, const std::string& name) {
    const Quantity quantity = quantityNamed(name).value();
    CsvColumn column;
    section.text("column", column.column, true);
    std::string unit = quantity.units.front().name;
    section.choice("unit", unit, namesOf(quantity.units));
    double scale = 1.0;
    section.number("scale", scale, {-1e6, 1e6}, "1");
    column.factor = scale * factorOf(quantity.units, unit);
    column.limit = quantity.limit;
    if (scale == 1.0) column.other_units = otherUnits(quantity.units, unit);
    const bool wheels = turnsWheels(unit) && name != "yaw_rate";
    if (wheels && wheel_radius_ == 0.0)
      throw section.error("unit", "needs wheel_radius, the metres from axle to rim");
    if (wheels) column.factor *= wheel_radius_;
    const std::optional<std::string> channel = channelBefore(name, kCommandOf);
    if (!channel) return column;
    const CommandKind kind = kindIn(unit);
    column.limit = kind == CommandKind::kTrackSpeed ? 100.0 : commandLimit(kind);
    for (const CommandChannel& other : mapping_.channels)
      if (isSide(*channel) && isSide(other.name) && other.kind != kind)
        throw section.error("unit", "one side is power, the other a speed");
    if (mapping_.channels.size() == Command::kMaxChannels)
      throw section.error(
          "column", "commands have up to " + std::to_string(Command::kMaxChannels) + " channels");
    mapping_.channels.push_back({*channel, kind, -commandLimit(kind), commandLimit(kind)});
    return column;
  }

  /// Left and right first, then the other channels in the order of their columns.
  void orderChannels() {
    const auto place = [](const CommandChannel& channel) {
      return channel.name == "left" ? 0 : channel.name == "right" ? 1 : 2;
    };
    std::stable_sort(mapping_.channels.begin(), mapping_.channels.end(),
                     [&](const auto& a, const auto& b) { return place(a) < place(b); });
  }

  void require(bool good, const std::string& problem) const {
    if (!good) throw reader_.error("tables", problem);
  }

  /// Checks that all required entries are present.
  void check() const {
    const auto both = [&](const std::string& a, const std::string& b) {
      require(mapping_.has(a) == mapping_.has(b), a + " and " + b + " come together");
    };
    both("left_command", "right_command");
    both("left_speed", "right_speed");
    both("x", "y");
    both("latitude", "longitude");
    both("roll", "pitch");
    for (const char* part : {"qx", "qy", "qz"}) both("qw", part);
    const bool metres = mapping_.has("x");
    const bool degrees = mapping_.has("latitude");
    require(!(metres && degrees), "x and latitude: give positions in one of the two");
    const int headings = (mapping_.has("yaw") ? 1 : 0) + (mapping_.has("qw") ? 1 : 0) +
                         (mapping_.course_above ? 1 : 0);
    require(
        !(metres || degrees) || headings == 1,
        "a pose needs one heading: yaw, a quaternion (qw, qx, qy, qz), or heading.course_above");
    for (const CsvSource& source : mapping_.sources)
      for (const auto& [quantity, column] : source.columns) requireChannelOf(quantity);
    require(
        !mapping_.course_above || mapping_.has("left_command") || mapping_.has("left_speed"),
        "heading.course_above needs commands or speeds, which show whether it drives backwards");
    require(metres || degrees || !mapping_.channels.empty(), "neither positions nor commands");
    for (const CsvSource& source : mapping_.sources) {
      require(mapping_.sources.size() == 1 || source.rate == 0.0,
              "rows without a time column cannot be combined with another table");
      require(mapping_.sources.size() == 1 || source.run.empty(),
              "run: a table with several drives cannot be combined with another table");
    }
  }

  /// Speed and current of a channel require its command, except for the speeds of left and right.
  void requireChannelOf(const std::string& quantity) const {
    for (const char* ending : {"_speed", "_current"}) {
      const std::optional<std::string> channel = channelBefore(quantity, ending);
      require(!channel || isSide(*channel) || mapping_.has(*channel + kCommandOf),
              quantity + ": there is no " + channel.value_or("") + kCommandOf);
    }
  }

  ConfigReader& reader_;
  CsvMapping mapping_;
  double wheel_radius_ = 0.0;  ///< [m] 0 = not given
};

}  // namespace

bool CsvMapping::has(const std::string& quantity) const {
  return std::any_of(sources.begin(), sources.end(),
                     [&](const CsvSource& source) { return source.columns.count(quantity) != 0; });
}

CsvMapping readCsvMapping(ConfigReader& reader) {
  return MappingReader(reader).read();
}

}  // namespace tread::import
