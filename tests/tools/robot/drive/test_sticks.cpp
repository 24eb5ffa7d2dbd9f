// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <filesystem>
#include <fstream>

#include <linux/input-event-codes.h>
#include <unistd.h>
#include <catch2/catch.hpp>

#include "tools/robot/drive/keyboard.hpp"
#include "tools/robot/drive/pad.hpp"

namespace tread::drive {
namespace {

/// A temporary recording.
struct Recording {
  explicit Recording(const std::string& text)
      : path(std::filesystem::temp_directory_path() /
             ("tread_pad_" + std::to_string(::getpid()) + ".evemu")) {
    std::ofstream(path) << text;
  }
  ~Recording() { std::filesystem::remove(path); }
  std::string path;
};

std::string refusalOf(const std::string& text) {
  const Recording file(text);
  try {
    const RecordedPad pad(file.path);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("both tracks get forward and turn, and a turn at full speed keeps its radius") {
  CHECK(mixed(0.5, 0.0) == TrackCommand{0.5, 0.5});
  CHECK(mixed(0.0, 0.5) == TrackCommand{-0.5, 0.5});  // to the left
  CHECK(mixed(1.0, 1.0) == TrackCommand{0.0, 1.0});
  const TrackCommand slow = mixed(0.5, 0.2);
  const TrackCommand fast = mixed(1.0, 0.4);
  CHECK(fast.left / fast.right == Approx(slow.left / slow.right));
  CHECK(fast.right == 1.0);
}

TEST_CASE("a stick's ends are full, its middle is nothing, and the numbers are the device's own") {
  PadState pad;
  pad.setRange(ABS_X, 0, 255);
  pad.setRange(ABS_Y, 0, 255);
  for (const int axis : {ABS_X, ABS_Y}) pad.begin(EV_ABS, axis, 0);
  for (const int axis : {ABS_X, ABS_Y}) pad.take(EV_ABS, axis, 128);
  CHECK(pad.wishes().forward == 0.0);
  CHECK(pad.wishes().turn == 0.0);
  pad.take(EV_ABS, ABS_Y, 0);
  pad.take(EV_ABS, ABS_X, 255);
  CHECK(pad.wishes().forward == 1.0);
  CHECK(pad.wishes().turn == -1.0);
  pad.take(EV_ABS, ABS_Y, 140);  // a worn spring
  CHECK(pad.wishes().forward == 0.0);
  pad.take(EV_ABS, ABS_Y, 99'999);
  CHECK(pad.wishes().forward == -1.0);
}

TEST_CASE("an axis counts from the first event that tells another value than it began with") {
  PadState pad;
  pad.setRange(ABS_X, 0, 255);
  pad.setRange(ABS_Y, 0, 255);
  const auto forward = [&] { return pad.wishes().forward; };
  CHECK(std::isnan(forward()));  // no measurement yet
  pad.begin(EV_ABS, ABS_Y, 0);
  CHECK(std::isnan(forward()));
  pad.take(EV_ABS, ABS_Y, 0);
  pad.take(EV_ABS, ABS_Y, 0);
  CHECK(std::isnan(forward()));  // a repetition is no movement
  pad.take(EV_ABS, ABS_Y, 255);
  CHECK(forward() == -1.0);
  CHECK(std::isnan(pad.wishes().turn));  // one axis does not imply the other
  pad.take(EV_ABS, ABS_X, 128);
  CHECK(std::isnan(pad.wishes().turn));  // its first value: unknown whether it moved
  pad.take(EV_ABS, ABS_X, 127);
  CHECK(pad.wishes().turn == 0.0);
  pad.take(EV_ABS, ABS_Y, 0);
  CHECK(forward() == 1.0);
}

TEST_CASE("what a recording begins with is what the kernel told, and no measurement") {
  const Recording file(
      "A: 00 0 255\nA: 01 0 255\nE: 3.000000 0003 0000 0\nE: 3.000000 0003 0001 0\n"
      "E: 3.000000 0003 0000 128\nE: 3.000000 0003 0001 128\nE: 3.100000 0003 0000 128\n"
      "E: 4.000000 0003 0000 129\nE: 5.000000 0003 0001 127\nE: 6.000000 0000 0000 0\n");
  RecordedPad pad(file.path);
  const TrackCommand begins = mixed(pad.read(0).forward, pad.read(0).turn);
  CHECK((std::isnan(begins.left) && std::isnan(begins.right)));
  CHECK(std::isnan(pad.read(500'000).turn));
  const Wishes one = pad.read(1'000'000);
  CHECK(one.turn == 0.0);
  CHECK((std::isnan(mixed(one.forward, one.turn).left)));
  const Wishes both = pad.read(2'000'000);
  CHECK(mixed(both.forward, both.turn) == TrackCommand{0.0, 0.0});
}

TEST_CASE("a keyboard is known from the start: no key pressed is a measurement") {
  const Wishes wishes = KeyState().wishes(1'000'000);
  CHECK(mixed(wishes.forward, wishes.turn) == TrackCommand{0.0, 0.0});
}

TEST_CASE("the dead-man's button is each shoulder, the others arm, disarm and give back") {
  PadState pad;
  CHECK_FALSE(pad.wishes().hold);
  pad.take(EV_KEY, BTN_TR, 1);
  CHECK(pad.wishes().hold);
  pad.take(EV_KEY, BTN_TR, 0);
  CHECK_FALSE(pad.wishes().hold);
  pad.take(EV_KEY, BTN_TRIGGER, 1);
  pad.take(EV_KEY, BTN_START, 1);
  pad.take(EV_KEY, BTN_NORTH, 1);
  CHECK(pad.wishes().hold);
  CHECK(pad.wishes().arm);
  CHECK(pad.wishes().give_back);
  CHECK_FALSE(pad.wishes().disarm);
  pad.take(EV_KEY, BTN_SELECT, 1);
  CHECK(pad.wishes().disarm);
}

TEST_CASE("a recording is played at its own speed, and says when it is over") {
  const Recording file(
      "# EVEMU 1.3\nN: pad\nA: 00 0 255 0 0 0\nA: 01 0 255 0 0 0\n"
      "E: 10.500000 0001 0137 0001\t# BTN_TR\nE: 10.500000 0003 0001 255\n"
      "E: 10.600000 0003 0001 128\nE: 10.700000 0003 0001 0\nE: 11.000000 0000 0000 0\n");
  RecordedPad pad(file.path);
  CHECK(pad.read(5'000'000).hold);
  CHECK(pad.read(5'190'000).forward == 0.0);
  CHECK(pad.read(5'200'000).forward == 1.0);
  CHECK_FALSE(pad.read(5'490'000).ended);
  CHECK(pad.read(5'500'000).ended);
}

TEST_CASE("a broken recording is refused in one line that says where") {
  CHECK_THAT(refusalOf("N: pad\n"), Catch::Contains("holds no event"));
  CHECK_THAT(refusalOf("E: 1.000000 0001 0137\n"), Catch::Contains(":1: an event is written"));
  CHECK_THAT(refusalOf("A: 00 0\n"), Catch::Contains(":1: an axis is written"));
  CHECK_THAT(refusalOf("E: 2.000000 0001 0137 1\nE: 1.000000 0001 0137 0\n"),
             Catch::Contains(":2: goes back in time"));
  CHECK_THROWS_WITH(RecordedPad("/nowhere.evemu"), Catch::Contains("/nowhere.evemu"));
}

TEST_CASE("a key drives while it repeats and 200 ms longer, space stops at once") {
  KeyState keys;
  CHECK_FALSE(keys.wishes(0).hold);
  keys.take("w", 1'000'000);
  CHECK(keys.wishes(1'190'000).hold);
  CHECK(keys.wishes(1'190'000).forward == 0.5);
  CHECK_FALSE(keys.wishes(1'200'000).hold);
  CHECK(keys.wishes(1'200'000).forward == 0.0);
  keys.take("\x1b[D", 2'000'000);  // an arrow
  CHECK(keys.wishes(2'000'000).turn == 0.5);
  keys.take("D", 2'050'000);
  CHECK(keys.wishes(2'050'000).turn == -1.0);
  keys.take("\x1b", 2'100'000);  // split by the terminal
  keys.take("[A", 2'110'000);
  CHECK(keys.wishes(2'110'000).forward == 0.5);
  CHECK(keys.wishes(2'110'000).turn == 0.0);
  keys.take(" ", 2'150'000);
  CHECK_FALSE(keys.wishes(2'150'000).hold);
  CHECK(keys.wishes(2'150'000).forward == 0.0);
}

TEST_CASE("the escape key and keys of many bytes stop, too") {
  KeyState keys;
  keys.take("w", 1'000'000);
  keys.take("\x1b", 1'020'000);
  CHECK(keys.wishes(1'030'000).forward == 0.5);  // it may become an arrow
  CHECK(keys.wishes(1'080'000).forward == 0.0);
  CHECK_FALSE(keys.wishes(1'080'000).hold);
  CHECK(keys.wishes(1'080'000).stop);
  CHECK_FALSE(keys.wishes(9'000'000).stop);  // a robot armed later is not disarmed by it
  keys.take("g", 1'100'000);                 // the next key does not cancel the stop
  CHECK(keys.wishes(1'110'000).give_back);
  CHECK_FALSE(keys.wishes(1'110'000).hold);
  for (const char* function_key :
       {"\x1bOP", "\x1b[15~", "\x1b[3~", "\x1b[1;2A", "\x1b[1;2D", "\x1b[1;5A"}) {
    keys.take("w", 2'000'000);
    REQUIRE(keys.wishes(2'010'000).hold);
    keys.take(function_key, 2'010'000);
    CHECK_FALSE(keys.wishes(2'010'000).hold);
  }
}

TEST_CASE("Enter arms with the hand at rest, until it is armed or a key stops it") {
  KeyState keys;
  keys.take("\n", 1'000'000);
  CHECK(keys.wishes(1'100'000).arm);
  CHECK_FALSE(keys.wishes(1'300'000).arm);
  CHECK(keys.wishes(2'400'000).hold);
  CHECK(keys.wishes(2'400'000).forward == 0.0);
  keys.take(" ", 2'400'000);
  CHECK_FALSE(keys.wishes(2'400'000).hold);
  keys.take("g\x7f", 3'000'000);
  CHECK(keys.wishes(3'000'000).give_back);
  CHECK(keys.wishes(3'000'000).disarm);
}

}  // namespace tread::drive
