// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>
#include <random>

#include "common/mcap/mcap_reader.hpp"
#include "common/mcap/mcap_writer.hpp"

using namespace tread;

namespace {

/// A temporary file.
class McapFile {
 public:
  explicit McapFile(const std::string& name)
      : path_((std::filesystem::temp_directory_path() / ("tread_mcap_" + name)).string()) {}
  ~McapFile() { std::filesystem::remove(path_); }
  McapFile(const McapFile&) = delete;
  McapFile& operator=(const McapFile&) = delete;
  const std::string& path() const { return path_; }

  std::string bytes() const {
    std::ifstream file(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void write(const std::string& bytes) const { std::ofstream(path_, std::ios::binary) << bytes; }

 private:
  std::string path_;
};

/// Two topics, several chunks.
void writeDrive(const std::string& path, int messages) {
  mcap::Writer writer(path);
  const uint16_t schema = writer.addSchema("tread.ins_t", "jsonschema", "{}");
  const uint16_t ins = writer.addChannel(schema, "INS", "json");
  const uint16_t other = writer.addChannel(0, "OTHER", "cbor");
  for (int i = 0; i < messages; ++i)
    writer.write(i % 10 == 0 ? other : ins, 1000 + static_cast<uint64_t>(i), 5,
                 "message " + std::to_string(i) + std::string(1000, 'x'));
  writer.close();
}

std::vector<mcap::Message> read(const std::string& path, std::string& problem) {
  mcap::Reader reader(path);
  std::vector<mcap::Message> messages;
  mcap::Message message;
  while (reader.next(message)) messages.push_back(message);
  problem = reader.problem();
  return messages;
}

}  // namespace

TEST_CASE("an MCAP file gives back what was written, over chunks, with topics and schemas") {
  const McapFile file("whole");
  writeDrive(file.path(), 3000);
  std::string problem;
  const auto messages = read(file.path(), problem);
  REQUIRE(problem.empty());
  REQUIRE(messages.size() == 3000);
  REQUIRE(messages[0].topic == "OTHER");
  REQUIRE(messages[0].schema_name.empty());
  REQUIRE(messages[0].encoding == "cbor");
  REQUIRE(messages[2999].topic == "INS");
  REQUIRE(messages[2999].schema_name == "tread.ins_t");
  REQUIRE(messages[2999].log_time == 3999);
  REQUIRE(messages[2999].data.rfind("message 2999x", 0) == 0);
  REQUIRE(file.bytes().size() < 300'000);  // 3 MB before compression
}

TEST_CASE("messages in another order than their times come by time, within and over chunks") {
  const McapFile file("order");
  {
    mcap::Writer writer(file.path());
    const uint16_t channel = writer.addChannel(0, "INS", "json");
    for (int i = 0; i < 3000; ++i) {
      // Each topic has its own chunks: the second half of the file overlaps the first in time.
      const int at = i < 1500 ? 2 * i : 2 * (i - 1500) + 1;
      writer.write(channel, static_cast<uint64_t>(at), 5,
                   std::to_string(at) + std::string(1000, 'x'));
    }
    writer.close();
  }
  std::string problem;
  const auto messages = read(file.path(), problem);
  REQUIRE(problem.empty());
  REQUIRE(messages.size() == 3000);
  for (size_t i = 0; i < 3000; ++i) {
    REQUIRE(messages[i].log_time == i);
    REQUIRE(messages[i].data.rfind(std::to_string(i) + "x", 0) == 0);
  }
}

TEST_CASE("messages of one time keep the order of the file") {
  const McapFile file("ties");
  {
    mcap::Writer writer(file.path());
    const uint16_t channel = writer.addChannel(0, "INS", "json");
    for (int i = 0; i < 100; ++i)
      writer.write(channel, static_cast<uint64_t>(7 - i / 25), 5, std::to_string(i));
    writer.close();
  }
  std::string problem;
  const auto messages = read(file.path(), problem);
  REQUIRE(messages.size() == 100);
  CHECK(messages.front().data == "75");
  CHECK(messages[1].data == "76");
  CHECK(messages.back().data == "24");
}

TEST_CASE("messages of a damaged chunk are counted by the index behind it") {
  const McapFile file("count");
  writeDrive(file.path(), 3000);
  std::string bytes = file.bytes();
  constexpr size_t kInFirstChunk = 300;
  bytes[kInFirstChunk] = static_cast<char>(bytes[kInFirstChunk] ^ 0x55);
  file.write(bytes);
  mcap::Reader reader(file.path());
  REQUIRE_FALSE(reader.problem().empty());
  CHECK(reader.lostMessages() > 0);
  CHECK(reader.messages() + reader.lostMessages() == 3000);
  CHECK(reader.lostBytes() > 0);
}

TEST_CASE("a truncated MCAP file gives its whole chunks, and says so") {
  const McapFile file("cut");
  writeDrive(file.path(), 3000);
  const std::string whole = file.bytes();
  size_t least = 3000, most = 0;
  for (const double share : {0.1, 0.3, 0.5, 0.6}) {
    file.write(whole.substr(0, static_cast<size_t>(share * static_cast<double>(whole.size()))));
    std::string problem;
    const size_t messages = read(file.path(), problem).size();
    REQUIRE_THAT(problem, Catch::Contains("is the file truncated?"));
    REQUIRE(mcap::Reader(file.path()).cutOff());
    least = std::min(least, messages);
    most = std::max(most, messages);
  }
  REQUIRE(least < most);
  REQUIRE(most < 3000);
}

TEST_CASE("damaged bytes of an MCAP file never crash its reader, and a damaged chunk is told") {
  const McapFile file("damaged");
  writeDrive(file.path(), 1500);
  const std::string whole = file.bytes();
  std::mt19937 random(3);
  int told = 0;
  for (int round = 0; round < 300; ++round) {
    std::string bytes = whole;
    for (int i = 0; i < 3; ++i)
      bytes[8 + random() % (bytes.size() - 8)] = static_cast<char>(random());
    file.write(bytes);
    std::string problem;
    REQUIRE(read(file.path(), problem).size() <= 1500);
    told += problem.empty() ? 0 : 1;
  }
  REQUIRE(told > 50);
}

TEST_CASE("what is no MCAP file is one clear line") {
  const McapFile file("none");
  file.write("what is this");
  CHECK_THROWS_WITH(mcap::Reader(file.path()), Catch::EndsWith("is no MCAP file"));
  CHECK_THROWS_WITH(mcap::Reader("/nowhere/drive.mcap"), Catch::EndsWith("cannot be opened"));
  CHECK_THROWS_WITH(mcap::Writer("/nowhere/drive.mcap"), Catch::Contains("cannot be written"));
}
