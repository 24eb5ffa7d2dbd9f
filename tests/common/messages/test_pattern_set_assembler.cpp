// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <functional>
#include <limits>
#include <random>

#include <catch2/catch.hpp>

#include "common/messages/pattern_messages.hpp"
#include "tests/common/pattern/pattern_samples.hpp"
#include "tests/helpers.hpp"

namespace tread {
namespace {

using tread::testing::kInf;
using tread::testing::kNan;

PatternSet setOf(int64_t version) {
  PatternSetContent content = testing::goodContent();
  content.version = version;
  content.parent_version = version - 1;
  std::string why;
  auto set = PatternSet::make(std::move(content), why);
  REQUIRE(set);
  return *set;
}

std::vector<pattern_set_part_t> partsOf(int64_t version) {
  return toMessages(setOf(version));
}

/// The last result of an assembler for these parts.
std::optional<PatternSet> addAll(PatternSetAssembler& assembler,
                                 const std::vector<pattern_set_part_t>& parts) {
  std::optional<PatternSet> last;
  for (const auto& part : parts)
    if (auto set = assembler.add(part)) last = std::move(set);
  return last;
}

std::vector<uint8_t> encoded(const pattern_set_part_t& part) {
  std::vector<uint8_t> bytes(static_cast<size_t>(part.getEncodedSize()));
  part.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

/// Whether these bytes decode completely as a message.
// Not inlined: g++ 12 reports a variable of the generated code as uninitialized otherwise.
[[gnu::noinline]] bool decodes(const std::vector<uint8_t>& bytes, pattern_set_part_t& part) {
  const int size = static_cast<int>(bytes.size());
  try {
    return part.decode(bytes.data(), 0, size) == size;
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace

TEST_CASE("a set comes out of its parts with the same checksum, in any order and with repeats") {
  const PatternSet set = setOf(7);
  auto parts = toMessages(set);
  REQUIRE(parts.size() == set.patterns().size());
  std::sort(parts.begin(), parts.end(),
            [](const auto& a, const auto& b) { return a.part < b.part; });
  do {
    PatternSetAssembler assembler;
    CHECK_FALSE(assembler.add(parts[1]));
    const auto got = addAll(assembler, parts);
    REQUIRE(got);
    CHECK(got->checksum() == set.checksum());
    CHECK(got->version() == 7);
    CHECK(got->content().utime == set.content().utime);
    CHECK(got->patterns()[0].name == set.patterns()[0].name);
    CHECK(assembler.refused() == 0);
  } while (std::next_permutation(parts.begin(), parts.end(),
                                 [](const auto& a, const auto& b) { return a.part < b.part; }));
}

TEST_CASE("a set survives encoding and decoding of its parts") {
  PatternSetAssembler assembler;
  std::optional<PatternSet> got;
  for (const auto& part : partsOf(7)) {
    pattern_set_part_t decoded{};
    REQUIRE(decodes(encoded(part), decoded));
    if (auto set = assembler.add(decoded)) got = std::move(set);
  }
  REQUIRE(got);
  CHECK(got->checksum() == setOf(7).checksum());
}

TEST_CASE("nothing comes out while a part is missing") {
  auto parts = partsOf(7);
  const auto missing = parts.back();
  parts.pop_back();
  PatternSetAssembler assembler;
  CHECK_FALSE(addAll(assembler, parts));
  CHECK_FALSE(addAll(assembler, parts));
  CHECK(assembler.add(missing));
}

TEST_CASE("versions only go up: what is not newer is passed over without a word") {
  PatternSetAssembler assembler;
  REQUIRE(addAll(assembler, partsOf(7)));
  CHECK_FALSE(addAll(assembler, partsOf(7)));
  CHECK_FALSE(addAll(assembler, partsOf(6)));
  CHECK(assembler.refused() == 0);
  CHECK(assembler.refusal().empty());
  CHECK(addAll(assembler, partsOf(9)));
  CHECK_FALSE(addAll(assembler, partsOf(8)));
}

TEST_CASE("an older version that is incomplete is dropped when a newer one is complete") {
  const auto old_parts = partsOf(7);
  PatternSetAssembler assembler;
  assembler.add(old_parts[0]);
  REQUIRE(addAll(assembler, partsOf(8)));
  CHECK_FALSE(addAll(assembler, old_parts));
}

TEST_CASE("a set with three channels goes over the bus as it is, in its commands and programs") {
  std::string why;
  const auto set = PatternSet::make(tread::testing::threeChannels(), why);
  REQUIRE(set);
  PatternSetAssembler assembler;
  const auto received = addAll(assembler, toMessages(*set));
  REQUIRE(received);
  CHECK(received->content().channels == set->content().channels);
  CHECK(received->patterns()[1].commands == set->patterns()[1].commands);
  PlannedExecution planned;
  planned.execution_id = 4;
  planned.pattern_id = 2;
  planned.set = *set;
  const program_slot_t slot = toMessage(planned);
  REQUIRE(slot.num_channels == 3);
  CHECK(slot.channel_kind[2] == program_slot_t::KIND_STEERING_ANGLE);
  CHECK(slot.command[1] == std::vector<float>{0.25F, 0.25F, -0.2F});
}

TEST_CASE("parts of two versions may come mixed") {
  const auto first = partsOf(7);
  const auto second = partsOf(8);
  PatternSetAssembler assembler;
  std::vector<int64_t> versions;
  for (size_t i = 0; i < first.size(); ++i) {
    if (auto set = assembler.add(second[i])) versions.push_back(set->version());
    if (auto set = assembler.add(first[i])) versions.push_back(set->version());
  }
  CHECK(versions == std::vector<int64_t>{8});
}

TEST_CASE("every field of a part is checked, with one line that says what is wrong") {
  using Change = std::function<void(pattern_set_part_t&)>;
  const std::vector<std::pair<const char*, Change>> changes{
      {"version is not", [](auto& p) { p.set_version = 0; }},
      {"parent version", [](auto& p) { p.parent_version = p.set_version; }},
      {"parent version", [](auto& p) { p.parent_version = -1; }},
      {"part count", [](auto& p) { p.part_count = 0; }},
      {"part count", [](auto& p) { p.part_count = 1 << 30; }},
      {"part number", [](auto& p) { p.part = -1; }},
      {"part number", [](auto& p) { p.part = p.part_count; }},
      {"command kind", [](auto& p) { p.channel_kind[0] = p.channel_kind[1] = 9; }},
      {"number of channels", [](auto& p) { p.num_channels = 0; }},
      {"number of channels", [](auto& p) { p.num_channels = 9; }},
      {"lengths", [](auto& p) { p.channel_lowest.pop_back(); }},
      {"lengths", [](auto& p) { p.entry_steady.push_back(0.0); }},
      {"period", [](auto& p) { p.set_period = -50000; }},
      {"name", [](auto& p) { p.pattern_name.clear(); }},
      {"name", [](auto& p) { p.entry_class = std::string(65, 'x'); }},
      {"motion class", [](auto& p) { p.entry_twist[1] = kNan; }},
      {"motion class", [](auto& p) { p.exit_steady[0] = kInf; }},
      {"covariance", [](auto& p) { p.end_covariance[5] = -kInf; }},
      {"negative", [](auto& p) { p.set_pattern_id = -1; }},
      {"negative", [](auto& p) { p.times_learned = -1; }},
      {"number of samples", [](auto& p) { p.num_samples = 0; }},
      {"number of samples", [](auto& p) { p.num_samples = -5; }},
      {"number of samples", [](auto& p) { p.num_samples = 1001; }},
      {"lengths", [](auto& p) { p.command.pop_back(); }},
      {"lengths", [](auto& p) { p.trajectory.pop_back(); }},
      {"command 1 is", [](auto& p) { p.command[1][0] = kNan; }},
      {"command 0 is", [](auto& p) { p.command[0].pop_back(); }},
      {"pose 1 is", [](auto& p) { p.trajectory[1][2] = -kInf; }},
      {"pose 0 is", [](auto& p) { p.trajectory[0].push_back(0.0); }}};
  for (const auto& [says, change] : changes) {
    auto part = partsOf(7)[1];
    change(part);
    PatternSetAssembler assembler;
    CHECK_FALSE(assembler.add(part));
    CHECK_THAT(assembler.refusal(), Catch::Contains(says) && Catch::Contains("PATTERN_SET"));
    CHECK(assembler.refusal().find('\n') == std::string::npos);
    CHECK(assembler.refused() == 1);
    CHECK(addAll(assembler, partsOf(7)));
  }
}

TEST_CASE("a changed part fails the checksum, and the next round is whole again") {
  auto parts = partsOf(7);
  parts[1].trajectory[0][0] += 1e-9;
  PatternSetAssembler assembler;
  CHECK_FALSE(addAll(assembler, parts));
  CHECK_THAT(assembler.refusal(), Catch::Contains("version 7: checksum differs"));
  CHECK(addAll(assembler, partsOf(7)));
  CHECK(assembler.refusal().empty());
}

TEST_CASE("parts that contradict each other are refused, and cost one round at most") {
  using Change = std::function<void(pattern_set_part_t&)>;
  const std::vector<Change> changes{
      [](auto& p) { p.set_checksum ^= 1; },   [](auto& p) { p.part_count += 1; },
      [](auto& p) { p.set_name += "x"; },     [](auto& p) { p.set_period += 1; },
      [](auto& p) { p.parent_version -= 1; }, [](auto& p) { p.utime += 1; }};
  for (const auto& change : changes) {
    for (size_t broken = 0; broken < 3; ++broken) {
      auto parts = partsOf(7);
      change(parts[broken]);
      PatternSetAssembler assembler;
      CHECK_FALSE(addAll(assembler, parts));
      CHECK(assembler.refused() >= 1);
      const auto whole = partsOf(7);
      CHECK((addAll(assembler, whole) || addAll(assembler, whole)));
    }
  }
}

TEST_CASE("two parts that tell different twists of a motion class are refused") {
  auto parts = partsOf(7);
  parts[1].entry_twist[0] += 0.1;
  PatternSetAssembler assembler;
  CHECK_FALSE(addAll(assembler, parts));
  CHECK_THAT(assembler.refusal(), Catch::Contains("different twists"));
}

TEST_CASE("what PatternSet::make refuses is refused with its reason") {
  auto parts = partsOf(7);
  parts[1].pattern_name = parts[0].pattern_name;
  PatternSetAssembler assembler;
  CHECK_FALSE(addAll(assembler, parts));
  CHECK_THAT(assembler.refusal(), Catch::Contains("unique"));
}

TEST_CASE("broken version numbers do not keep the true version out") {
  std::mt19937_64 random(5);
  PatternSetAssembler assembler;
  const auto parts = partsOf(7);
  std::optional<PatternSet> got;
  for (const auto& part : parts) {
    auto broken = part;
    broken.set_version = static_cast<int64_t>(random() >> 1);
    CHECK_FALSE(assembler.add(broken));
    if (auto set = assembler.add(part)) got = std::move(set);
  }
  REQUIRE(got);
  CHECK(got->version() == 7);
  CHECK(addAll(assembler, partsOf(8)));
}

TEST_CASE("random bytes on the channel never crash and never make a set") {
  std::mt19937_64 random(11);
  const auto parts = partsOf(7);
  PatternSetAssembler assembler;
  int sets = 0;
  for (int round = 0; round < 20000; ++round) {
    std::vector<uint8_t> bytes = encoded(parts[random() % parts.size()]);
    for (int i = 0; i < 3; ++i)
      bytes[8 + random() % (bytes.size() - 8)] ^= static_cast<uint8_t>(1 + random() % 255);
    pattern_set_part_t decoded{};
    if (!decodes(bytes, decoded)) continue;
    if (const auto set = assembler.add(decoded)) {
      ++sets;
      // The checksum allows changes only in fields that it does not cover.
      CHECK(set->checksum() == setOf(7).checksum());
    }
  }
  CHECK(sets <= 1);
}

}  // namespace tread
