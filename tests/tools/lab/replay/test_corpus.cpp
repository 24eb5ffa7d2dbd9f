// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "tests/tools/called_program.hpp"

using namespace tread::samples;

namespace {

const std::string kCorpus = std::string(TREAD_SOURCE_DIR) + "/tests/data/corpus";

}  // namespace

TEST_CASE("the project's own corpus is planned and learned from as it was when it was recorded") {
  const CalledProgram replay = called("tread-replay corpus " + kCorpus);
  // Shows the effect of an intended change; then run tests/data/corpus/record.
  CAPTURE(replay.printed);
  CHECK(replay.status == 0);
  CHECK(replay.says("2 logs: 2 equal, 0 different, 0 not compared"));
}

TEST_CASE("another configuration is shown with the log, the field, the moment and both values") {
  const CalledProgram replay = called("tread-replay corpus " + kCorpus +
                                      " --set planner.search.horizon=6 --set learner.rule=off");
  CAPTURE(replay.printed);
  CHECK(replay.status == 1);
  CHECK(replay.says("2 logs: 0 equal, 2 different"));
  CHECK(replay.says("planner: "));
  CHECK(replay.says("learner: "));
  CHECK(replay.says("PLAN: "));
}

TEST_CASE("a corpus that is none, or a key that does not exist, is told in a line") {
  const OwnFolder folder;
  const CalledProgram empty = called("tread-replay corpus " + folder.path(""));
  CHECK(empty.status == 2);
  CHECK(empty.isOneLine());
  const CalledProgram other = called("tread-replay corpus " + kCorpus + " --set mapping.step=1");
  CHECK(other.status == 2);
  CHECK(other.isOneLine());
  const CalledProgram unknown =
      called("tread-replay corpus " + kCorpus + " --set planner.no_such_key=1");
  CHECK(unknown.status == 1);
  CHECK(unknown.says("has no key no_such_key"));
  folder.write("broken.lcmlog", "no log");
  const CalledProgram broken = called("tread-replay corpus " + folder.path(""));
  CHECK(broken.status == 1);
  CHECK(broken.says("broken.lcmlog: NOT COMPARED"));
}
