// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "common/fence/fence_book.hpp"
#include "common/messages/fence_messages.hpp"

using namespace tread;

namespace {

Fence square(const std::string& name, double side) {
  return {name, false, {{0, 0}, {side, 0}, {side, side}, {0, side}}};
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
  // Another one of the same name narrows further: it takes nothing away.
  CHECK(book.take({"stranger", false, square("yard", 99)}, false) == FenceReceipt::kAdded);
  CHECK(book.fences().size() == 2);
  CHECK(book.count("yard") == 2);
}

TEST_CASE("only who holds the robot removes a fence, and nobody removes the robot's own") {
  FenceBook book({square("site", 50)});
  book.take({"ada", false, square("yard", 9)}, true);
  book.take({"ada", false, square("yard", 8)}, true);
  CHECK(book.take(removal("yard"), false) == FenceReceipt::kForbidden);
  CHECK(book.count("yard") == 2);
  CHECK(book.take(removal("site"), true) == FenceReceipt::kNotThere);
  CHECK(book.count("site") == 1);
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
