// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>

#include "common/report/hash.hpp"
#include "tests/study/hide/bad_log.hpp"
#include "tests/study/hide/blind_bench.hpp"
#include "tests/study/hide/sealed_folder.hpp"
#include "tests/study/hide/suite.hpp"

using namespace tread;
using namespace tread::blind;
using tread::blind::bench::Folder;
using tread::blind::bench::shortPlan;

namespace fs = std::filesystem;

namespace {

/// Writes a few cases of half a minute, those of a shard only.
void writeCases(const Folder& folder, size_t shard, size_t shards) {
  const std::string part =
      shards == 1 ? "" : std::to_string(shard + 1) + "of" + std::to_string(shards);
  SealedFolder sealed(folder.path(), part);
  const auto plans = suiteOf("small", 0.5, 4);
  for (size_t i = shard; i < 6; i += shards) sealed.add(plans[i].name, makeCase(plans[i]));
}

std::map<std::string, std::string> filesOf(const Folder& folder) {
  std::map<std::string, std::string> files;
  for (const char* part : {"blind", "sealed"})
    for (const auto& entry : fs::directory_iterator(folder.path(part))) {
      const std::string name = part + ("/" + entry.path().filename().string());
      files[name] = folder.content(name);
    }
  return files;
}

}  // namespace

TEST_CASE("SHA-256 is that of the standard") {
  CHECK(sha256("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(sha256("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(sha256(std::string(1'000'000, 'a')) ==
        "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_CASE("same seed, same bytes, and another seed gives others") {
  Folder a, b, c;
  CasePlan plan = shortPlan({"yaw_breakaway"});
  SealedFolder(a.path()).add("x", makeCase(plan));
  SealedFolder(b.path()).add("x", makeCase(plan));
  plan.seed = 18;
  SealedFolder(c.path()).add("x", makeCase(plan));
  CHECK(unseal(a.path()).empty());
  CHECK(unseal(b.path()).empty());
  CHECK(filesOf(a) == filesOf(b));
  CHECK(a.content("blind/x.lcm") != c.content("blind/x.lcm"));
}

TEST_CASE("shards merge to the whole, byte by byte") {
  Folder whole, parts;
  writeCases(whole, 0, 1);
  for (size_t shard = 0; shard < 3; ++shard) writeCases(parts, shard, 3);
  mergeCommitments(parts.path());
  CHECK(unseal(whole.path()).empty());
  CHECK(unseal(parts.path()).empty());
  CHECK(filesOf(whole) == filesOf(parts));
}

TEST_CASE("the truth is committed and sealed, and a changed one is noticed") {
  Folder folder;
  const MadeCase made = makeCase(shortPlan({"slip_ratio"}));
  SealedFolder(folder.path()).add("0001", made);
  const auto mode = fs::status(folder.path("sealed")).permissions();
  CHECK((mode & fs::perms::all) == fs::perms::none);
  const std::string list = folder.content("blind/commitments.txt");
  CHECK(list.find(sha256(made.truth) + "  sealed/0001.json\n") == 0);
  CHECK(unseal(folder.path()).empty());
  CHECK(folder.content("sealed/0001.json") == made.truth);
  std::ofstream(folder.path("sealed/0001.json"), std::ios::app) << " ";
  const auto wrong = unseal(folder.path());
  REQUIRE(wrong.size() == 1);
  CHECK(wrong.front() == "sealed/0001.json: is not what was committed");
}

TEST_CASE("a case is never overwritten") {
  Folder folder;
  const MadeCase made = makeCase(shortPlan({}));
  SealedFolder(folder.path()).add("0001", made);
  CHECK_THROWS_WITH(SealedFolder(folder.path()).add("0001", made), Catch::Contains("exists"));
}

TEST_CASE("a truncated log ends inside an event") {
  Folder folder;
  CasePlan plan = shortPlan({});
  plan.kind = CaseKind::kBad;
  plan.defect = "truncated";
  SealedFolder(folder.path()).add("0001", makeCase(plan));
  LogReader reader(folder.path("blind/0001.lcm"));
  LogEvent event;
  size_t whole = 0;
  while (reader.next(event)) ++whole;
  CHECK(whole > 100);
  CHECK_FALSE(reader.problem().empty());
}

TEST_CASE("the program hides, opens and refuses in words") {
  Folder folder;
  const std::string hide = std::string(TREAD_BIN_DIR) + "/tread-hide ";
  const std::string quiet = " >" + folder.path("out") + " 2>&1";
  const std::string out = " --out " + folder.path("cases");
  const auto run = [&](const std::string& arguments) {
    return std::system((hide + arguments + quiet).c_str());
  };
  REQUIRE(run("--null --minutes 0.5 --seed 3" + out) == 0);
  REQUIRE(run("--effect yaw_pull,gyro_bias --minutes 0.5 --name 0002" + out) == 0);
  CHECK(run("unseal" + out) == 0);
  CHECK(folder.content("cases/sealed/0002.json").find("\"kind\": \"pair\"") != std::string::npos);
  CHECK(run("semi --log " + folder.path("cases/blind/0001.lcm") +
            " --effect track_asymmetry --name 0003" + out) == 0);
  CHECK(run("unseal" + out) == 0);
  CHECK(run("--effect wings --name 0004" + out) != 0);
  CHECK(folder.content("out").find("effect 'wings' is unknown") != std::string::npos);
  fs::permissions(folder.path("cases/sealed"), fs::perms::owner_all);
  fs::remove_all(folder.path("cases"));
}
