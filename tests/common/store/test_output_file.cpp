// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include <catch2/catch.hpp>

#include "common/store/output_file.hpp"
#include "common/store/store.hpp"

namespace tread {
namespace {

namespace fs = std::filesystem;
using Catch::Contains;

/// A temporary folder with a file that must not be lost.
class Place {
 public:
  Place() {
    std::string pattern = (fs::temp_directory_path() / "tread_output_XXXXXX").string();
    path = ::mkdtemp(pattern.data());
    writeText(old(), "precious");
  }
  ~Place() { fs::remove_all(path); }
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;

  std::string operator/(const std::string& name) const { return path + "/" + name; }
  std::string old() const { return path + "/old.txt"; }
  size_t files() const {
    return static_cast<size_t>(
        std::distance(fs::directory_iterator(path), fs::directory_iterator()));
  }

  std::string path;
};

void refuses(const std::vector<PlannedOutput>& outputs, const std::vector<std::string>& inputs,
             const std::string& words, bool replace = false) {
  CAPTURE(outputs.front().path, words);
  CHECK_THROWS_WITH(checkOutputs(outputs, inputs, replace), Contains(words));
}

}  // namespace

TEST_CASE("nothing stands under the name before the commit, and nothing is left of what had none") {
  const Place place;
  {
    OutputFile file(place.old());
    file.write("new");
    file.flush();
    CHECK(readText(place.old()) == "precious");
    CHECK(place.files() == 2);
  }
  CHECK(readText(place.old()) == "precious");
  CHECK(place.files() == 1);
  writeText(place.old(), "new");
  CHECK(readText(place.old()) == "new");
  CHECK(place.files() == 1);
}

TEST_CASE("a link stays a link, and a file keeps its rights") {
  const Place place;
  fs::create_symlink("old.txt", place / "link");
  fs::create_symlink("not yet", place / "dangling");
  ::chmod(place.old().c_str(), 0600);
  writeText(place / "link", "through the link");
  writeText(place / "dangling", "made");
  CHECK(fs::is_symlink(place / "link"));
  CHECK(readText(place.old()) == "through the link");
  CHECK(fs::is_symlink(place / "dangling"));
  CHECK(readText(place / "not yet") == "made");
  struct stat status {};
  REQUIRE(::stat(place.old().c_str(), &status) == 0);
  CHECK((status.st_mode & 0777U) == 0600U);
}

TEST_CASE("a name as long as the file system takes can be written") {
  const Place place;
  const std::string name(255, 'n');
  writeText(place / name, "x");
  CHECK(readText(place / name) == "x");
}

TEST_CASE("pipes and the standard streams are written to as they stand") {
  const Place place;
  writeText("/dev/null", "x");
  REQUIRE(::mkfifo((place / "pipe").c_str(), 0600) == 0);
  std::fflush(nullptr);  // the child must not print the buffered output again
  const pid_t writer = ::fork();
  if (writer == 0) {
    // Into the file behind the stream, after its content.
    ::close(STDOUT_FILENO);
    if (::open(place.old().c_str(), O_WRONLY | O_APPEND) != STDOUT_FILENO) ::_exit(1);
    writeText("/dev/stdout", ", and more");
    writeText(place / "pipe", "through the pipe");
    ::_exit(0);
  }
  CHECK(readText(place / "pipe") == "through the pipe");
  int status = 1;
  ::waitpid(writer, &status, 0);
  CHECK(status == 0);
  CHECK(readText(place.old()) == "precious, and more");
  checkOutputs({{"/dev/stdout"}, {"/dev/null"}, {place / "pipe"}}, {}, false);
}

TEST_CASE("a growing file is there at once and never opens one that is") {
  const Place place;
  CHECK_THROWS_AS(OutputFile(place.old(), OutputFile::Kind::kGrowing), WriteError);
  {
    OutputFile file(place / "drive", OutputFile::Kind::kGrowing);
    file.write("one");
    file.flush();
    CHECK(readText(place / "drive") == "one");
  }
  CHECK(readText(place / "drive") == "one");
  moveAside(place / "drive");
  writeText(place / "drive", "two");
  moveAside(place / "drive");
  moveAside(place / "drive");
  CHECK(readText(place / "drive.1") == "one");
  CHECK(readText(place / "drive.2") == "two");
}

TEST_CASE("once a write has failed nothing takes the place of what was there") {
  const Place place;
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const rlimit tight{100, before.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  std::string first, then;
  {
    OutputFile file(place.old());
    ::setrlimit(RLIMIT_FSIZE, &tight);
    file.write(std::string(1000, 'x'));
    try {
      file.flush();
    } catch (const WriteError& error) {
      first = error.what();
    }
    ::setrlimit(RLIMIT_FSIZE, &before);  // there is space again, but the file has a gap
    try {
      file.commit();
    } catch (const WriteError& error) {
      then = error.what();
    }
  }
  std::signal(SIGXFSZ, handler);
  CHECK(first == place.old() + ": cannot be written (File too large); check space and permissions");
  CHECK(then == first);
  CHECK(readText(place.old()) == "precious");
  CHECK(place.files() == 1);
}

TEST_CASE("files of a folder take their places together, and others stay") {
  const Place place;
  {
    OutputFolder folder(place.path);
    writeText(folder.path() + "/old.txt", "new");
    writeText(folder.path() + "/a.txt", "a");
    CHECK(readText(place.old()) == "precious");
  }
  CHECK(readText(place.old()) == "precious");
  CHECK(place.files() == 1);
  { const OutputFolder folder(place / "never"); }
  CHECK_FALSE(fs::exists(place / "never"));
  OutputFolder folder(place.path);
  writeText(folder.path() + "/a.txt", "a");
  folder.commit();
  CHECK(readText(place / "a.txt") == "a");
  CHECK(readText(place.old()) == "precious");
}

TEST_CASE("an output that is an input by any name, or is there, is refused in one line") {
  const Place place;
  fs::create_hard_link(place.old(), place / "hard");
  fs::create_symlink("old.txt", place / "soft");
  for (const bool replace : {false, true})
    for (const std::string& name :
         {place.old(), place / "hard", place / "soft", place / "./old.txt",
          place.path + "/../" + fs::path(place.path).filename().string() + "/old.txt"})
      refuses({{name}}, {"7", place.old()}, "this is the input", replace);
  refuses({{place.old()}}, {}, "is there already");
  checkOutputs({{place.old()}}, {}, true);
  refuses({{place.old()}}, {place.path}, "lies in the input", true);
  checkOutputs({{place / "fresh"}}, {place.path}, false);
  refuses({{place / "a"}, {place / "./a"}}, {}, "two results");
  refuses({{place.path}}, {}, "it is a folder");
  refuses({{place / "no/such"}}, {}, "is not there");
  refuses({{place / "old.txt/x"}}, {}, "is no folder");
  refuses({{"/proc/x"}}, {}, "cannot be written");
  CHECK(readText(place.old()) == "precious");
}

TEST_CASE("a folder as output must be empty, and hold no input") {
  using Kind = PlannedOutput::Kind;
  const Place place;
  refuses({{place.path, Kind::kFolder}}, {}, "not empty");
  checkOutputs({{place.path, Kind::kFolder}}, {}, true);
  refuses({{place.path, Kind::kFolder}}, {place.old()}, "lies there", true);
  refuses({{place.old(), Kind::kFolder}}, {}, "it is no folder", true);
  refuses({{place.old(), Kind::kEither}}, {}, "is there already");
  refuses({{place / "old.txt/x", Kind::kFolder}}, {}, "is no folder");
  checkOutputs({{place / "not/yet", Kind::kFolder}}, {place.old()}, false);
  fs::create_directories(place / "empty/1.unfinished");
  checkOutputs({{place / "empty", Kind::kFolder}}, {}, false);
}

}  // namespace tread
