// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <csignal>

#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/seal/key_file.hpp"
#include "tests/helpers.hpp"

using namespace tread;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

/// A temporary folder.
struct KeyFolder {
  KeyFolder() { fs::create_directories(path); }
  ~KeyFolder() { fs::remove_all(path); }
  KeyFolder(const KeyFolder&) = delete;
  KeyFolder& operator=(const KeyFolder&) = delete;
  std::string file(const std::string& name) const { return path / name; }

  const fs::path path = fs::temp_directory_path() / ("tread_key_" + std::to_string(getpid()));
};

std::string written(const std::string& path, const std::string& text, mode_t mode = 0600) {
  std::ofstream(path) << text;
  REQUIRE(chmod(path.c_str(), mode) == 0);
  return path;
}

const std::string kDigits(64, 'a');

}  // namespace

TEST_CASE("a new key is private, readable, unlike others, and never in the place of a file") {
  const KeyFolder folder;
  const std::string one = folder.file("one");
  const std::string two = folder.file("two");
  const mode_t before = umask(0);
  writeNewKey(one);
  umask(before);
  writeNewKey(two);
  struct stat entry {};
  REQUIRE(stat(one.c_str(), &entry) == 0);
  CHECK((entry.st_mode & 07777) == 0600);
  CHECK(readKey(one).bytes == readKey(one).bytes);
  CHECK(readKey(one).bytes != readKey(two).bytes);
  CHECK(fingerprint(readKey(one)) == fingerprint(readKey(one)));
  CHECK(fingerprint(readKey(one)) != fingerprint(readKey(two)));
  const std::string content = testing::contentOf(one);
  CHECK_THROWS_WITH(writeNewKey(one), Contains("File exists") && Contains("never overwritten"));
  CHECK(testing::contentOf(one) == content);
  fs::create_symlink(folder.file("elsewhere"), folder.file("link"));
  CHECK_THROWS(writeNewKey(folder.file("link")));
  CHECK_THROWS_WITH(writeNewKey(folder.file("no/such")), Contains("cannot be made"));
}

TEST_CASE("a fingerprint does not tell the key") {
  const KeyFolder folder;
  const std::string path = written(folder.file("key"), kDigits + "\n");
  CHECK(fingerprint(readKey(path)).size() == 19);
  CHECK(kDigits.find(fingerprint(readKey(path)).substr(0, 4)) == std::string::npos);
}

TEST_CASE("a key that group or others may touch is refused, whatever they may do") {
  const KeyFolder folder;
  for (const mode_t mode : {0640, 0604, 0620, 0602, 0610, 0601, 0644, 0777}) {
    CAPTURE(mode);
    const std::string path = written(folder.file("key"), kDigits + "\n", mode);
    CHECK_THROWS_WITH(readKey(path),
                      Contains("key " + path + ": others than its owner") && Contains("chmod 600"));
  }
  for (const mode_t mode : {0600, 0400})
    CHECK_NOTHROW(readKey(written(folder.file("key"), kDigits + "\n", mode)));
}

TEST_CASE("a key of somebody else is refused") {
  const KeyFolder folder;
  const std::string path = written(folder.file("key"), kDigits + "\n");
  if (chown(path.c_str(), 4321, static_cast<gid_t>(-1)) != 0) {
    WARN("skipped: only root may give a file away");
    return;
  }
  CHECK_THROWS_WITH(readKey(path), Contains("belongs to user 4321, not to user 0"));
}

TEST_CASE("what is no key is refused in one line with what to do") {
  const KeyFolder folder;
  const std::string half = kDigits.substr(32);
  for (const std::string& text :
       {std::string(), std::string("# only a comment\n"), half, kDigits + "a", kDigits + kDigits,
        kDigits + "\n" + kDigits + "\n", "key: " + kDigits, std::string(64, 'g'),
        kDigits.substr(1) + " ", kDigits + "\r\n", std::string(100000, 'a'),
        kDigits + "\n" + half + "\n", half + "\n" + kDigits + "\n", std::string(64, '\0')}) {
    CAPTURE(text.substr(0, 100), text.size());
    CHECK_THROWS_WITH(
        readKey(written(folder.file("key"), text)),
        Contains("holds no key") && Contains("remove it, then make one with tread-key"));
  }
  CHECK_THROWS_WITH(readKey(folder.file("none")),
                    Contains("No such file") && Contains("tread-key"));
  CHECK_THROWS_WITH(readKey(folder.path), Contains("is no file"));
  REQUIRE(mkfifo(folder.file("pipe").c_str(), 0600) == 0);
  CHECK_THROWS_WITH(readKey(folder.file("pipe")), Contains("is no file"));
  CHECK(readKey(written(folder.file("key"), "# why\n\n" + kDigits)).bytes[31] == 0xaa);
}

TEST_CASE(
    "a start that is killed while it writes the key leaves none, and the next start makes one") {
  const KeyFolder folder;
  const std::string path = folder.file("key");
  const pid_t killed = fork();
  if (killed == 0) {
    // The kernel kills the process at its first written byte.
    const rlimit nothing{0, 0};
    std::signal(SIGXFSZ, SIG_DFL);
    setrlimit(RLIMIT_CORE, &nothing);
    setrlimit(RLIMIT_FSIZE, &nothing);
    ensureKey(path);
    _exit(0);
  }
  int status = 0;
  REQUIRE(waitpid(killed, &status, 0) == killed);
  REQUIRE(WIFSIGNALED(status));
  CHECK(WTERMSIG(status) == SIGXFSZ);
  CHECK_FALSE(fs::exists(path));
  CHECK(ensureKey(path));
  CHECK_NOTHROW(readKey(path));
}

TEST_CASE(
    "two processes of a host with one key understand each other, without one there is no seal") {
  const KeyFolder folder;
  writeNewKey(folder.file("key"));
  auto one = hostSealer(folder.file("key"));
  auto two = hostSealer(folder.file("key"));
  REQUIRE((one && two));
  std::vector<uint8_t> bytes(20);
  REQUIRE(one->seal("ARM", bytes, 1'000'000));
  CHECK(two->open("ARM", bytes.data(), bytes.size(), 1'000'000).verdict == SealVerdict::kGood);
  CHECK_FALSE(hostSealer(""));
}
