// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <sstream>

#include "tools/robot/setup/interview.hpp"

using namespace tread;
using namespace tread::setup;
using Catch::Matchers::Contains;

namespace {

AnswersFile answersOf(const std::string& text) {
  return {ConfigReader::fromText(text, "answers.yaml"), [](const std::string&) {}};
}

}  // namespace

TEST_CASE("a file answers what it has, the usual where it has nothing, and refuses the rest") {
  AnswersFile file = answersOf("name: mole\nfront: 0.65\nwheels_up: yes\nfirst_track: up\n");
  CHECK(file.ask("name") == "mole");
  CHECK(file.number("front", {0.1, 2.0}) == 0.65);
  CHECK(file.number("ins_x", {-1.0, 1.0}) == 0.0);
  CHECK_NOTHROW(file.confirm("wheels_up"));
  CHECK_THROWS_WITH(file.confirm("wheels_down"), Contains("wheels_down is missing"));
  CHECK_THROWS_WITH(file.number("front", {0.1, 0.5}), Contains("answers: front: '0.65'"));
  CHECK_THROWS_WITH(file.choice("first_track", {"left", "right"}), Contains("left, right"));
  CHECK_THROWS_WITH(answersOf("nmae: mole\n"), Contains("nmae"));
}

TEST_CASE(
    "at a terminal questions are asked, a bare return is the usual, nothing moves without yes") {
  std::istringstream typed("  0.4 \n\nno\n");
  std::ostringstream shown;
  Terminal terminal(typed, shown);
  CHECK(terminal.number("front", {0.1, 2.0}) == 0.4);
  CHECK(terminal.number("ins_x", {-1.0, 1.0}) == 0.0);
  CHECK_THROWS_WITH(terminal.confirm("wheels_up"), Contains("nothing is moved"));
  CHECK_THROWS_WITH(terminal.ask("go"), Contains("no answer"));
  CHECK_THAT(shown.str(), Contains("How far does it extend forward") && Contains("[0]"));
}
