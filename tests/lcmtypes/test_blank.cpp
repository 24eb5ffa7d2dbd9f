// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Default values of messages, compared with the documentation of each field in the .lcm files.
#include <cmath>
#include <cstring>
#include <fstream>
#include <regex>

#include <catch2/catch.hpp>

#include "common/messages/blank.hpp"
#include "type_samples.hpp"

namespace tread {
namespace {

/// Compares a type's .lcm file with the bytes of its blank message.
class BlankCheck {
 public:
  explicit BlankCheck(std::vector<uint8_t> bytes) : bytes_(std::move(bytes)) {}

  void check(const std::string& type) {
    std::ifstream file(std::string(TREAD_SOURCE_DIR) + "/lcmtypes/tread/" + type + ".lcm");
    const std::regex field(R"(^ +(\w+) +(\w+)((?:\[\w+\])*);(.*))");
    std::smatch match;
    for (std::string line; std::getline(file, line);)
      if (std::regex_match(line, match, field)) check(match[1], match[2], match[3], match[4]);
  }
  bool allRead() const { return at_ == bytes_.size(); }
  int fields = 0;

 private:
  void check(const std::string& type, const std::string& name, const std::string& sizes,
             const std::string& comment) {
    INFO(type << " " << name << sizes << ";" << comment);
    ++fields;
    size_t count = 1;
    if (!sizes.empty()) {
      const std::string size = sizes.substr(1, sizes.find(']') - 1);
      if (size.find_first_not_of("0123456789") != std::string::npos) return;  // is empty
      count = std::stoul(size);
    }
    // "-1 unknown", "-1 = none": a special value.
    const bool minus = std::regex_search(comment, std::regex("; -1( |$)"));
    for (size_t i = 0; i < count; ++i) checkValue(type, minus);
  }

  void checkValue(const std::string& type, bool minus) {
    if (type == "double" || type == "float") {
      CHECK(std::isnan(type == "double" ? number<double, uint64_t>() : number<float, uint32_t>()));
    } else if (type == "int64_t") {
      CHECK((minus ? integer(8) == -1 : integer(8) >= 0));
    } else if (type == "int32_t") {
      CHECK((minus ? integer(4) == -1 : integer(4) >= 0));
    } else if (type == "int16_t") {
      CHECK((minus ? integer(2) == -1 : integer(2) >= 0));
    } else if (type == "boolean" || type == "byte") {
      CHECK(integer(1) == 0);
    } else if (type == "string") {
      CHECK(integer(4) == 1);  // its terminating zero
      CHECK(integer(1) == 0);
    } else {
      check(type);
    }
  }

  int64_t integer(size_t size) {
    REQUIRE(at_ + size <= bytes_.size());
    int64_t value = (bytes_[at_] & 0x80) != 0 && size > 1 ? -1 : 0;
    for (size_t i = 0; i < size; ++i) value = value * 256 + bytes_[at_++];
    return value;
  }
  template <class Number, class Bits>
  double number() {
    const auto bits = static_cast<Bits>(integer(sizeof(Bits)));
    Number value = 0;
    std::memcpy(&value, &bits, sizeof value);
    return static_cast<double>(value);
  }

  std::vector<uint8_t> bytes_;
  size_t at_ = 8;  ///< after the fingerprint
};

}  // namespace

TEST_CASE("a blank message says of each field that it is unknown, as its .lcm file does") {
  testing::forEachType([](const auto& sample) {
    using Message = std::decay_t<decltype(sample)>;
    INFO(Message::getTypeName());
    BlankCheck blank_check(testing::encode(blank<Message>()));
    blank_check.check(Message::getTypeName());
    CHECK(blank_check.fields >= 2);
    CHECK(blank_check.allRead());
  });
}

TEST_CASE("a blank INS message claims nothing") {
  const auto ins = blank<ins_t>();
  CHECK(ins.ins_status == (ins_t::STATUS_NO_POSITION | ins_t::STATUS_NO_HEADING |
                           ins_t::STATUS_NO_ATTITUDE | ins_t::STATUS_NO_VELOCITY));
  CHECK(ins.satellites == -1);
  CHECK(blank<motor_t>().command_index == -1);
}

}  // namespace tread
