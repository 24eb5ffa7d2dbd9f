// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <functional>

#include <catch2/catch.hpp>

#include "common/fence/kept_fences.hpp"

namespace tread {
namespace {

const std::string kEntries[] = {"fences_of_holders", "fences_of_others"};
const std::string kMarker = "fences_are_kept";

Fence square(const std::string& name, double half) {
  return {name, true, {{-half, -half}, {half, -half}, {half, half}, {-half, half}}};
}

/// A store with three fences.
MemoryStore kept() {
  MemoryStore store;
  REQUIRE_FALSE(
      writeFences(store, {{square("pond", 1.0 / 3.0), square("ditch", 2)}, {square("tree", 0.5)}}));
  return store;
}

size_t count(const KeptFences& fences) {
  return fences.holders.size() + fences.others.size();
}

/// Alters one entry: its content counts as lost.
void loses(const std::string& entry, const std::function<void(Store&, const std::string&)>& harm) {
  MemoryStore store = kept();
  harm(store, *store.read(entry));
  const KeptFences fences = readFences(store);
  CHECK(fences.lost);
  CHECK(fences.holders.empty() == (entry == kEntries[0]));
  CHECK(fences.others.empty() == (entry == kEntries[1]));
}

}  // namespace

TEST_CASE("fences come out of the store as they were kept, and none out of a new one") {
  const KeptFences fences = readFences(kept());
  CHECK_FALSE(fences.lost);
  CHECK(fences.holders == std::vector<Fence>{square("pond", 1.0 / 3.0), square("ditch", 2)});
  CHECK(fences.others == std::vector<Fence>{square("tree", 0.5)});
  const KeptFences none = readFences(MemoryStore());
  CHECK_FALSE(none.lost);
  CHECK(count(none) == 0);
  MemoryStore removed = kept();
  writeFences(removed, {});
  CHECK_FALSE(readFences(removed).lost);
  CHECK(count(readFences(removed)) == 0);
  MemoryStore full;
  full.failWith("disk full");
  CHECK(writeFences(full, {}) == std::optional<std::string>("disk full"));
}

TEST_CASE("an entry that is missing, empty, truncated, longer, or has one bit flipped is lost") {
  for (const std::string& entry : kEntries) {
    loses(entry, [&](Store& store, const std::string&) { store.remove(entry); });
    const size_t size = kept().read(entry)->size();
    for (size_t at = 0; at < size; ++at) {
      CAPTURE(entry, at);
      loses(entry, [&](Store& store, std::string text) { store.write(entry, text.substr(0, at)); });
      for (int bit = 0; bit < 8; ++bit)
        loses(entry, [&](Store& store, std::string text) {
          text[at] = static_cast<char>(text[at] ^ (1 << bit));
          store.write(entry, text);
        });
    }
    loses(entry, [&](Store& store, const std::string& text) {
      store.write(entry, text + "keep_out 3 0 0 1 0 1 1 more\n");
    });
    loses(entry, [&](Store& store, const std::string& text) {
      store.write(entry, text.substr(text.find('\n') + 1));  // without its first line
    });
  }
}

TEST_CASE("a damaged marker loses nothing, and each entry is a marker for the other one") {
  for (const char* marker : {"", "nonsense", "gone"}) {
    MemoryStore store = kept();
    store.write(kMarker, marker);
    if (std::string(marker) == "gone") store.remove(kMarker);
    CHECK_FALSE(readFences(store).lost);
    CHECK(count(readFences(store)) == 3);
    for (const std::string& entry : kEntries) {
      MemoryStore one = store;
      one.remove(entry);
      CHECK(readFences(one).lost);
      one.write(entry, "");
      CHECK(readFences(one).lost);
    }
  }
  MemoryStore marker_alone = kept();
  for (const std::string& entry : kEntries) marker_alone.remove(entry);
  CHECK(readFences(marker_alone).lost);
}

TEST_CASE("fences of an older version, without checksum and marker, are taken if all can be read") {
  MemoryStore store;
  store.write(kEntries[0], toText({square("pond", 1)}));
  store.write(kEntries[1], "");
  CHECK_FALSE(readFences(store).lost);
  CHECK(readFences(store).holders == std::vector<Fence>{square("pond", 1)});
  store.write(kEntries[0], toText({square("pond", 1)}) + "keep_out 3 0 0 1\n");
  CHECK(readFences(store).lost);
}

TEST_CASE("an entry that is there and cannot be read is lost") {
  struct Unreadable : MemoryStore {
    std::optional<std::string> read(const std::string& /*name*/) const override { return {}; }
  };
  Unreadable store;
  store.write(kEntries[0], toText({square("pond", 1)}));
  CHECK(readFences(store).lost);
}

}  // namespace tread
