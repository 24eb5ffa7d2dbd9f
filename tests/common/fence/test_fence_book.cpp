// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>

#include <catch2/catch.hpp>

#include "common/bus/virtual_bus.hpp"
#include "common/fence/fence_book.hpp"
#include "common/messages/blank.hpp"
#include "common/messages/fence_messages.hpp"

using namespace tread;

namespace {

Fence square(const std::string& name, double side) {
  return {name, false, {{0, 0}, {side, 0}, {side, side}, {0, side}}};
}

/// Number of fences of this name in force.
int64_t countOf(const FenceBook& book, const std::string& name) {
  return std::count_if(book.fences().begin(), book.fences().end(),
                       [&](const Fence& fence) { return fence.name == name; });
}

FenceRequest removal(const std::string& name) {
  return {"ada", true, {name, false, {}}};
}

}  // namespace

TEST_CASE("one more fence is taken from everybody, and the same again changes nothing") {
  FenceBook book;
  CHECK(book.take({"stranger", false, square("yard", 9)}, false) == FenceReceipt::kAdded);
  CHECK(book.take({"stranger", false, square("yard", 9)}, false) == FenceReceipt::kKnown);
  CHECK(book.revision() == 1);
  // A second one of the same name restricts further.
  CHECK(book.take({"stranger", false, square("yard", 99)}, false) == FenceReceipt::kAdded);
  CHECK(book.fences().size() == 2);
  CHECK(countOf(book, "yard") == 2);
}

TEST_CASE("only who holds the robot removes a fence, and nobody removes the robot's own") {
  FenceBook book({square("site", 50)});
  book.take({"ada", false, square("yard", 9)}, true);
  book.take({"ada", false, square("yard", 8)}, true);
  CHECK(book.take(removal("yard"), false) == FenceReceipt::kForbidden);
  CHECK(countOf(book, "yard") == 2);
  CHECK(book.take(removal("site"), true) == FenceReceipt::kNotThere);
  CHECK(countOf(book, "site") == 1);
  CHECK(book.take(removal("yard"), true) == FenceReceipt::kRemoved);
  CHECK(book.take(removal("yard"), true) == FenceReceipt::kNotThere);
  REQUIRE(book.fences().size() == 1);
  CHECK(book.fences()[0].name == "site");
}

TEST_CASE("what is no fence is refused, and so are more than a robot can look after") {
  FenceBook book;
  CHECK(book.take({"ada", false, {"line", false, {{0, 0}, {1, 1}}}}, true) ==
        FenceReceipt::kInvalid);
  for (size_t i = 0; i < FenceBook::kMost; ++i)
    CHECK(book.take({"ada", false, square("f" + std::to_string(i), 9)}, true) ==
          FenceReceipt::kAdded);
  CHECK(book.take({"ada", false, square("more", 9)}, true) == FenceReceipt::kFull);
}

TEST_CASE("strangers' fences make room for those of who holds the robot, the oldest first") {
  FenceBook book({square("site", 50)});
  CHECK(book.take({"ada", false, square("yard", 9)}, true) == FenceReceipt::kAdded);
  for (size_t i = 2; i < FenceBook::kMost; ++i)
    CHECK(book.take({"stranger", false, square("s" + std::to_string(i), 99)}, false) ==
          FenceReceipt::kAdded);
  CHECK(book.take({"stranger", false, square("more", 9)}, false) == FenceReceipt::kFull);
  const int64_t revision = book.revision();
  CHECK(book.take({"ada", false, square("people", 9)}, true) == FenceReceipt::kAdded);
  CHECK(book.revision() == revision + 1);
  CHECK(book.fences().size() == FenceBook::kMost);
  CHECK(countOf(book, "s2") == 0);
  // The holder's own request is also stored as the holder's.
  CHECK(book.take({"ada", false, square("s3", 99)}, true) == FenceReceipt::kKnown);
  for (size_t i = 4; i < FenceBook::kMost; ++i)
    CHECK(book.take({"ada", false, square("a" + std::to_string(i), 9)}, true) ==
          FenceReceipt::kAdded);
  CHECK(book.take({"ada", false, square("last", 9)}, true) == FenceReceipt::kFull);
  for (const char* kept : {"site", "yard", "people", "s3", "a4"}) CHECK(countOf(book, kept) == 1);
  CHECK(countOf(book, "s4") == 0);
  // A holder's fence removed and a stranger's added instead: it is removed again.
  CHECK(book.take(removal("yard"), true) == FenceReceipt::kRemoved);
  CHECK(book.take({"stranger", false, square("more", 9)}, false) == FenceReceipt::kAdded);
  CHECK(book.take({"ada", false, square("last", 9)}, true) == FenceReceipt::kAdded);
  CHECK(countOf(book, "more") == 0);
}

TEST_CASE("so many corners as the motor bridge cannot look at in a step are not taken") {
  const auto disc = [](double radius) {
    Fence fence{"disc", true, {}};
    for (size_t i = 0; i < Fence::kMostCorners; ++i) {
      const double angle = 2.0 * kPi * static_cast<double>(i) / Fence::kMostCorners;
      fence.corners.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    return fence;
  };
  FenceBook book;
  for (size_t i = 0; i < FenceBook::kMostCorners / Fence::kMostCorners; ++i)
    CHECK(book.take({"", false, disc(1.0 + static_cast<double>(i))}, false) ==
          FenceReceipt::kAdded);
  CHECK(book.take({"", false, square("small", 1)}, false) == FenceReceipt::kFull);
  CHECK(book.take({"ada", false, square("small", 1)}, true) == FenceReceipt::kAdded);
}

TEST_CASE("FENCES says each second and after each change which fences are kept, and no others") {
  struct Teller : Node {
    explicit Teller(Bus& bus) : exchange(bus, "teller", "none", [](const FenceRequest&) {}) {}
    int64_t period() const override { return 100'000; }
    void step(int64_t utime) override {
      const std::string last = "f" + std::to_string(count);
      if (utime < 3'000'000) {
        if (count > 0) book.take(removal(last), true);
        book.take({"ada", false, square("f" + std::to_string(++count), 9)}, true);
      }
      exchange.step(book);
    }
    FenceBook book{{square("site", 50)}};
    FenceExchange exchange;
    int count = 0;
  };
  VirtualBus bus{1};
  std::vector<fences_t> told;
  bus.outside().subscribe<fences_t>(kFences,
                                    [&](const fences_t& message) { told.push_back(message); });
  bus.addNode("teller", [](Bus& end) { return std::make_unique<Teller>(end); });
  bus.runUntil(3'000'000);
  CHECK(told.size() >= 20);
  for (size_t i = 0; i < told.size(); ++i) {
    const std::vector<Fence> fences = fencesFrom(told[i]);
    CHECK(told[i].keeper == "teller");
    CHECK(told[i].num_own == 1);
    REQUIRE(fences.size() == 2);
    CHECK(fences[0] == square("site", 50));
    CHECK(fences[1] == square("f" + std::to_string(i + 1), 9));
  }
  told.clear();
  bus.runUntil(8'000'000);
  CHECK(told.size() >= 4);
  CHECK(told.size() <= 6);
}

TEST_CASE("who is started again gets the operators' fences back, and what is removed stays away") {
  struct Keeper : Node {
    Keeper(Bus& bus, const std::string& name, const std::string& other)
        : exchange(bus, name, other,
                   [this](const FenceRequest& request) { book.take(request, false); }) {
      bus.subscribe<fence_t>(kFence, [this](const fence_t& message) {
        book.take(requestFrom(message), message.fence_by == "ada");
      });
    }
    int64_t period() const override { return 10'000; }
    void step(int64_t /*utime*/) override { exchange.step(book); }
    FenceBook book{{square("site", 50)}};
    FenceExchange exchange;
  };
  VirtualBus bus{1};
  std::map<std::string, Keeper*> keepers;
  const auto add = [&](const std::string& name, const std::string& other) {
    bus.addNode(name, [&keepers, name, other](Bus& end) {
      auto keeper = std::make_unique<Keeper>(end, name, other);
      keepers[name] = keeper.get();
      return keeper;
    });
  };
  const auto send = [&](const FenceRequest& request) {
    fence_t message = toMessage(request);
    message.utime = bus.now();
    bus.outside().publish(kFence, message);
    bus.runUntil(bus.now() + 3'000'000);
  };
  add("one", "two");
  add("two", "one");
  send({"ada", false, square("yard", 9)});
  send({"ada", false, square("pond", 3)});
  for (const std::string name : {"one", "two"}) {
    bus.kill(name);
    bus.restart(name);
    bus.runUntil(bus.now() + 1'200'000);
    CHECK(keepers[name]->book.fences().size() == 3);
    const int64_t revision = keepers[name]->book.revision();
    bus.runUntil(bus.now() + 3'000'000);
    CHECK(keepers[name]->book.revision() == revision);
  }
  send(removal("yard"));
  for (const auto& [name, keeper] : keepers) {
    CHECK(countOf(keeper->book, "yard") == 0);
    CHECK(countOf(keeper->book, "pond") == 1);
  }
}

TEST_CASE(
    "a fence that was removed does not come back with what the other keeper said before it knew") {
  struct Keeper : Node {
    explicit Keeper(Bus& bus)
        : exchange(bus, "one", "two",
                   [this](const FenceRequest& request) { book.take(request, false); }) {}
    int64_t period() const override { return 10'000; }
    void step(int64_t /*utime*/) override { exchange.step(book); }
    FenceBook book;
    FenceExchange exchange;
  };
  VirtualBus bus{1};
  Keeper* keeper = nullptr;
  bus.addNode("one", [&keeper](Bus& end) {
    auto made = std::make_unique<Keeper>(end);
    keeper = made.get();
    return made;
  });
  keeper->book.take({"ada", false, square("yard", 9)}, true);
  bus.runUntil(bus.now() + 100'000);
  keeper->book.take(removal("yard"), true);
  bus.runUntil(bus.now() + 100'000);
  const auto otherSays = [&] {
    auto message = blank<fences_t>();
    message.utime = bus.now();
    message.keeper = "two";
    message.fences = {toMessage(FenceRequest{"", false, square("yard", 9)})};
    message.num_fences = 1;
    bus.outside().publish(kFences, message);
    bus.runUntil(bus.now() + 50'000);
  };
  otherSays();
  CHECK(keeper->book.fences().empty());
  bus.runUntil(bus.now() + 1'000'000);
  otherSays();
  CHECK(keeper->book.fences().size() == 1);
}

TEST_CASE("fences go through text unchanged, and broken lines make no fence") {
  const std::vector<Fence> fences{square("the yard", 1.0 / 3.0),
                                  {"pond", true, {{0, 1}, {2, 3}, {4, -5}}}};
  int broken = 0;
  CHECK(fencesFrom(toText(fences), broken) == fences);
  CHECK(broken == 0);
  const std::string lines =
      "stay_in 3 0 0 1 0 1 nan a\nstay_in 4 0 0 1 0 1 1 b\nstay_in 99999999999 0 0 c\n"
      "elsewhere 3 0 0 1 0 1 1 d\nstay_in 3 0 0 1 0 1 1 \n\nkeep_out 3 0 0 1 0 1 1 e\n";
  CHECK(fencesFrom(lines, broken).size() == 1);
  CHECK(broken == 6);
}

TEST_CASE("a fence goes through its message unchanged, and broken messages make no fence") {
  const FenceRequest request{"ada", false, {"pond", true, {{0, 1}, {2, 3}, {4, -5}}}};
  const FenceRequest again = requestFrom(toMessage(request));
  CHECK(again.by == "ada");
  CHECK_FALSE(again.removes);
  CHECK(again.fence == request.fence);
  CHECK(requestFrom(toMessage(removal("pond"))).removes);
  fence_t odd = toMessage(request);
  odd.fence_kind = 7;
  CHECK_FALSE(faultOf(requestFrom(odd).fence).empty());
  odd = toMessage(request);
  odd.corners[1].pop_back();
  CHECK_FALSE(faultOf(requestFrom(odd).fence).empty());
}

TEST_CASE("each answer to a request for a fence has words of its own") {
  std::set<std::string> words;
  for (const FenceReceipt receipt :
       {FenceReceipt::kAdded, FenceReceipt::kKnown, FenceReceipt::kRemoved, FenceReceipt::kNotThere,
        FenceReceipt::kForbidden, FenceReceipt::kInvalid, FenceReceipt::kFull,
        static_cast<FenceReceipt>(99)})
    words.insert(describe(receipt));
  CHECK(words.size() == 8);
}

TEST_CASE(
    "lost fences bar everything until who holds the robot removes them, in a full book, too") {
  FenceBook book{{square("site", 50)}};
  CHECK(book.bar().empty());
  for (int i = 0;
       book.take({"ada", false, square("p" + std::to_string(i), 1)}, true) == FenceReceipt::kAdded;
       ++i)
    REQUIRE(i < 40);
  CHECK(book.take({"planner", false, lostFences()}, false) == FenceReceipt::kAdded);
  CHECK(book.take({"planner", false, lostFences()}, false) == FenceReceipt::kKnown);
  CHECK(book.bar() == "kept fences are lost: set them anew, then tread-fence lost_fences --remove");
  CHECK(book.take(removal("lost_fences"), false) == FenceReceipt::kForbidden);
  CHECK_FALSE(book.bar().empty());
  CHECK(book.take(removal("lost_fences"), true) == FenceReceipt::kRemoved);
  CHECK(book.bar().empty());
  CHECK(faultOf(lostFences()).empty());
}
