// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cstdlib>
#include <map>

#include "tests/study/hide/blind_bench.hpp"
#include "tests/study/hide/case_folder.hpp"

using namespace tread;
using namespace tread::blind;
using tread::blind::bench::Folder;
using tread::blind::bench::shortPlan;

namespace fs = std::filesystem;

namespace {

std::map<std::string, std::string> filesOf(const Folder& folder) {
  std::map<std::string, std::string> files;
  for (const char* part : {"blind", "truth"})
    for (const auto& entry : fs::directory_iterator(folder.path(part))) {
      const std::string name = part + ("/" + entry.path().filename().string());
      files[name] = folder.content(name);
    }
  return files;
}

}  // namespace

TEST_CASE("same seed, same bytes, and another seed gives others") {
  Folder a, b, c;
  CasePlan plan = shortPlan({"yaw_breakaway"});
  writeCase(a.path(), "x", makeCase(plan));
  writeCase(b.path(), "x", makeCase(plan));
  plan.seed = 18;
  writeCase(c.path(), "x", makeCase(plan));
  CHECK(filesOf(a) == filesOf(b));
  CHECK(a.content("blind/x.lcm") != c.content("blind/x.lcm"));
}

TEST_CASE("a case is never overwritten") {
  Folder folder;
  const MadeCase made = makeCase(shortPlan({}));
  writeCase(folder.path(), "0001", made);
  CHECK_THROWS_WITH(writeCase(folder.path(), "0001", made), Catch::Contains("exists"));
}

TEST_CASE("a truncated log ends inside an event") {
  Folder folder;
  CasePlan plan = shortPlan({});
  plan.kind = CaseKind::kBad;
  plan.defect = "truncated";
  writeCase(folder.path(), "0001", makeCase(plan));
  LogReader reader(folder.path("blind/0001.lcm"));
  LogEvent event;
  size_t whole = 0;
  while (reader.next(event)) ++whole;
  CHECK(whole > 100);
  CHECK_FALSE(reader.problem().empty());
}

TEST_CASE("the program hides and refuses in words") {
  Folder folder;
  const std::string hide = std::string(TREAD_BIN_DIR) + "/tread-hide ";
  const std::string quiet = " >" + folder.path("out") + " 2>&1";
  const std::string out = " --out " + folder.path("cases");
  const auto run = [&](const std::string& arguments) {
    return std::system((hide + arguments + quiet).c_str());
  };
  REQUIRE(run("--null --minutes 0.5 --seed 3" + out) == 0);
  REQUIRE(run("--effect yaw_pull,gyro_bias --minutes 0.5 --name 0002" + out) == 0);
  CHECK(folder.content("cases/truth/0002.json").find("\"kind\": \"pair\"") != std::string::npos);
  CHECK(run("semi --log " + folder.path("cases/blind/0001.lcm") +
            " --effect track_asymmetry --name 0003" + out) == 0);
  CHECK(run("--effect wings --name 0004" + out) != 0);
  CHECK(folder.content("out").find("effect 'wings' is unknown") != std::string::npos);
}
