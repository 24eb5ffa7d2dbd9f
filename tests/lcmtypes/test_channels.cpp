// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

#include <catch2/catch.hpp>

#include "type_samples.hpp"

namespace tread {
namespace {

constexpr int kMostBytes = 60'000;  // from 130 kB on LCM silently loses most messages

}  // namespace

TEST_CASE("the channel table names the type that each channel really carries") {
  std::vector<std::string> typed;
  testing::forEachChannel([&](const auto& channel, const auto& sample) {
    INFO(channel.name);
    CHECK(std::string(channel.type) == std::decay_t<decltype(sample)>::getTypeName());
    typed.push_back(channel.name);
  });
  std::vector<std::string> table;
  for (const ChannelSpec& channel : kChannels) table.push_back(channel.name);
  std::sort(table.begin(), table.end());
  std::sort(typed.begin(), typed.end());
  CHECK(table == typed);
}

TEST_CASE("channel names are unique, short, and plain where LCM reads a regular expression") {
  std::set<std::string> names;
  for (const ChannelSpec& channel : kChannels) {
    const std::string name = channel.name;
    INFO(name);
    CHECK(names.insert(name).second);
    CHECK((!name.empty() && name.size() <= 63));
    CHECK(name.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ_") == std::string::npos);
    CHECK_FALSE(std::string(channel.publisher).empty());
    CHECK((channel.rate_hz >= 0.0 && channel.max_age_ms >= 0));
  }
}

TEST_CASE("no channel may carry a message that LCM would lose") {
  for (const ChannelSpec& channel : kChannels) {
    INFO(channel.name);
    CHECK(channel.max_bytes > 0);
    CHECK(channel.max_bytes <= kMostBytes);
  }
  testing::forEachChannel([](const auto& channel, const auto& sample) {
    INFO(channel.name);
    CHECK(static_cast<int>(testing::encode(sample).size()) <= channel.max_bytes);
  });
}

TEST_CASE("the largest messages that the types promise fit their channels") {
  auto part = testing::sampleOf<pattern_set_part_t>();
  part.num_samples = 1000;
  part.command.assign(1000, {0.0, 0.0});
  part.trajectory.assign(1000, {0.0, 0.0, 0.0});
  part.set_name = part.pattern_name = part.entry_class = part.exit_class = std::string(64, 'x');
  CHECK(part.getEncodedSize() <= kPatternSet.max_bytes);
  auto state = testing::sampleOf<learner_state_t>();
  state.num_bytes = 50'000;
  state.state_bytes.assign(50'000, 0);
  CHECK(state.getEncodedSize() <= kLearnerState.max_bytes);
  auto config = testing::sampleOf<config_t>();
  config.config_text = std::string(50'000, 'x');
  CHECK(config.getEncodedSize() <= kConfig.max_bytes);
  auto execution = testing::sampleOf<execution_t>();
  execution.num_records = 8;
  execution.records.assign(8, testing::sampleOf<execution_record_t>());
  for (auto& record : execution.records) record.outcome_reason = std::string(100, 'x');
  CHECK(execution.getEncodedSize() <= kExecution.max_bytes);
  auto program = testing::sampleOf<program_t>();
  for (program_slot_t* slot : {&program.running, &program.next}) {
    slot->num_commands = 1000;
    slot->command.assign(1000, {0.0F, 0.0F});  // the largest number of a pattern
  }
  CHECK(program.getEncodedSize() <= kProgram.max_bytes);
}

TEST_CASE("utime and seq are the first fields of every type on a channel") {
  for (const ChannelSpec& channel : kChannels) {
    const std::string path =
        std::string(TREAD_SOURCE_DIR) + "/lcmtypes/tread/" + channel.type + ".lcm";
    std::ifstream file(path);
    std::vector<std::string> fields;
    std::string line;
    while (std::getline(file, line) && line != "{") {
    }
    while (fields.size() < 2 && std::getline(file, line)) {
      std::istringstream words(line.substr(0, line.find(';')));
      std::string type;
      std::string name;
      if (words >> type >> name) fields.push_back(type + " " + name);
    }
    INFO(path);
    CHECK(fields == std::vector<std::string>{"int64_t utime", "int64_t seq"});
  }
}

}  // namespace tread
