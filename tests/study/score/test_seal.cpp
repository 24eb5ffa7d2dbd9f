// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include <catch2/catch.hpp>

#include "tests/study/score/child.hpp"
#include "tests/study/score/seal_watch.hpp"

using namespace tread::blindtest;
namespace fs = std::filesystem;

namespace {

/// A sealed folder with one truth in it.
class Sealed {
 public:
  Sealed() {
    fs::create_directories(path_ / "sealed");
    std::ofstream(path_ / "sealed/0001.json") << "{}";
    fs::permissions(path_ / "sealed", fs::perms::none);
  }
  ~Sealed() {
    fs::permissions(path_ / "sealed", fs::perms::owner_all);
    fs::remove_all(path_);
  }
  std::string folder() const { return path_.string(); }
  std::string sealed() const { return (path_ / "sealed").string(); }

  /// Runs a shell line as tread-gap is run, with the seals hidden or only shut.
  Ended shell(const std::string& line, bool hide) const {
    return run({{"/bin/sh", "-c", line}, folder(), "log.txt", hide ? sealed() : ""});
  }

 private:
  fs::path path_ = fs::temp_directory_path() / ("tread-seal-" + std::to_string(getpid()));
};

}  // namespace

TEST_CASE("whoever opens a sealed file is seen, also with the rights of root") {
  const Sealed sealed;
  SealWatch watch(sealed.sealed());
  CHECK(watch.touched().empty());
  sealed.shell("chmod 700 sealed; cat sealed/0001.json", false);
  CHECK_FALSE(watch.touched().empty());
  CHECK(watch.touched().empty());
}

TEST_CASE("a child has no sealed folder where namespaces are allowed") {
  if (!canHide()) {
    WARN("skipped: no mount namespace is allowed here");
    return;
  }
  const Sealed sealed;
  SealWatch watch(sealed.sealed());
  CHECK(sealed.shell("chmod 700 sealed; cat sealed/0001.json", true).status != 0);
  CHECK(sealed.shell("echo said > answer", true).status == 0);
  CHECK(fs::exists(sealed.folder() + "/answer"));
  CHECK(watch.touched().empty());
}

TEST_CASE("a child's status and last words are told") {
  const Sealed sealed;
  CHECK(sealed.shell("exit 13", false).status == 13);
  CHECK(sealed.shell("kill -9 $$", false).status == 128 + 9);
  CHECK(run({{"/bin/sh", "-c", "while :; do :; done"}, sealed.folder(), "log.txt", "", 1}).status >
        128);
  sealed.shell("echo first; echo last; echo", false);
  CHECK(lastLine(sealed.folder() + "/log.txt") == "last");
  CHECK_THROWS_WITH(run({{"/no/such/program"}, sealed.folder(), "log.txt", ""}),
                    Catch::Contains("cannot be started"));
  CHECK_THROWS_WITH(runOrThrow({{"/bin/sh", "-c", "echo why; exit 1"}, sealed.folder(), "log", ""}),
                    Catch::Contains("why"));
}
