// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include <catch2/catch.hpp>

#include "common/store/store.hpp"

namespace tread {
namespace {

namespace fs = std::filesystem;
using Catch::Contains;

/// A temporary folder.
class Folder {
 public:
  Folder() {
    std::string pattern = (fs::temp_directory_path() / "tread_store_XXXXXX").string();
    path = ::mkdtemp(pattern.data());
  }
  ~Folder() { fs::remove_all(path); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::string path;
};

void checkStore(Store& store) {
  CHECK(store.names().empty());
  CHECK_FALSE(store.read("set"));
  const std::string content("a\0b\n", 4);
  CHECK_FALSE(store.write("set", content));
  CHECK_FALSE(store.write("learner-1.state_x", ""));
  CHECK(store.read("set") == content);
  CHECK(store.read("learner-1.state_x") == std::string());
  CHECK_FALSE(store.write("set", "second"));
  CHECK(store.read("set") == std::string("second"));
  CHECK(store.names() == std::vector<std::string>{"learner-1.state_x", "set"});
  store.remove("set");
  store.remove("never there");
  CHECK(store.names() == std::vector<std::string>{"learner-1.state_x"});
}

void checkNames(Store& store) {
  for (const char* bad : {"", ".", "..", ".hidden", "a/b", "../x", "a b", "a\nb", "\xc3\xa4"}) {
    const auto refused = store.write(bad, "x");
    REQUIRE(refused);
    CHECK_THAT(*refused, Contains("letters, digits"));
    CHECK_FALSE(store.read(bad));
    store.remove(bad);
  }
  CHECK(store.write(std::string(201, 'a'), "x"));
  CHECK(store.names().empty());
}

}  // namespace

TEST_CASE("both stores keep, replace, list and remove entries") {
  const Folder folder;
  FileStore files(folder.path + "/deep/er");
  MemoryStore memory;
  checkStore(files);
  checkStore(memory);
}

TEST_CASE("both stores refuse the same names, and none leaves the folder") {
  const Folder folder;
  FileStore files(folder.path);
  MemoryStore memory;
  checkNames(files);
  checkNames(memory);
}

TEST_CASE("entries are found again by a new store of the folder") {
  const Folder folder;
  FileStore(folder.path).write("set", std::string(300000, 'x'));
  CHECK(FileStore(folder.path).read("set") == std::string(300000, 'x'));
}

TEST_CASE("a second process on the folder of another is refused in one line, until that one ends") {
  const Folder folder;
  {
    const FileStore first(folder.path);
    CHECK_THROWS_WITH(FileStore(folder.path), Contains("is in use by another process"));
  }
  CHECK_NOTHROW(FileStore(folder.path));
}

TEST_CASE("leftovers of a crash are no entries and are cleaned at the next start") {
  const Folder folder;
  FileStore(folder.path).write("set", "whole");
  std::ofstream(folder.path + "/set.123.unfinished") << "hal";
  fs::create_directory(folder.path + "/subfolder");
  FileStore store(folder.path);
  CHECK_FALSE(fs::exists(folder.path + "/set.123.unfinished"));
  CHECK(store.names() == std::vector<std::string>{"set"});
  CHECK(store.read("set") == std::string("whole"));
  CHECK_FALSE(store.read("subfolder"));
}

TEST_CASE("a full disk is one clear line and the old content stays") {
  const Folder folder;
  FileStore store(folder.path);
  REQUIRE_FALSE(store.write("set", "old"));
  // A file size limit fails in the middle of writing, like a full disk.
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const rlimit tight{1000, before.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ::setrlimit(RLIMIT_FSIZE, &tight);
  const auto refused = store.write("set", std::string(5000, 'x'));
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  REQUIRE(refused);
  CHECK_THAT(*refused, Contains(folder.path + "/set: cannot be written (File too large)"));
  CHECK(store.read("set") == std::string("old"));
  CHECK(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()) == 1);
}

TEST_CASE("a folder that vanished is one clear line") {
  const Folder folder;
  FileStore store(folder.path + "/gone");
  fs::remove_all(folder.path + "/gone");
  const auto refused = store.write("set", "x");
  REQUIRE(refused);
  CHECK_THAT(*refused, Contains("No such file or directory"));
  CHECK(store.names().empty());
}

TEST_CASE("a folder that cannot be made throws one clear line") {
  const Folder folder;
  std::ofstream(folder.path + "/file") << "x";
  CHECK_THROWS_WITH(FileStore(folder.path + "/file"), Contains("store: cannot use the folder"));
  CHECK_THROWS_WITH(FileStore(folder.path + "/file/below"), Contains("cannot use the folder"));
}

TEST_CASE("a process killed while writing leaves the old or the new, whole") {
  const Folder folder;
  FileStore store(folder.path);
  const std::string a(200000, 'a');
  const std::string b(150000, 'b');
  store.write("set", a);
  for (int round = 0; round < 10; ++round) {
    const pid_t writer = ::fork();
    if (writer == 0) {
      for (;;) {
        store.write("set", b);
        store.write("set", a);
      }
    }
    ::usleep(static_cast<useconds_t>(2000 + 3100 * round));
    ::kill(writer, SIGKILL);
    ::waitpid(writer, nullptr, 0);
    const auto content = store.read("set");
    REQUIRE(content);
    CHECK((*content == a || *content == b));
    CHECK(store.names() == std::vector<std::string>{"set"});
  }
}

TEST_CASE("a memory store fails as told and works again") {
  MemoryStore store;
  store.write("set", "old");
  store.failWith("store: cannot write set (No space left on device)");
  CHECK(store.write("set", "new") ==
        std::string("store: cannot write set (No space left on device)"));
  CHECK(store.read("set") == std::string("old"));
  store.failWith("");
  CHECK_FALSE(store.write("set", "new"));
  CHECK(store.read("set") == std::string("new"));
}

}  // namespace tread
