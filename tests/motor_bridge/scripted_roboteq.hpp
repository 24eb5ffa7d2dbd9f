// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace tread::motor {

/// A small Roboteq for tests, from the manual: received and sent lines, motor output.
/** Only commands feed the watchdog; after its expiry any valid command without a zero first resumes
 * the old speed, as documented. */
class ScriptedRoboteq {
 public:
  // Faults that a test can set.
  bool mute = false;       ///< its replies are lost
  bool deaf = false;       ///< it receives nothing
  bool mute_plus = false;  ///< only its acknowledgements are lost
  int refuse = 0;          ///< so many of the next commands are refused
  int lose = 0;            ///< so many of the next replies are lost
  int cut = 0;             ///< so many of the next replies lose their second half and their CR
  int fault_flags = 0;
  int status_flags = 1;
  long forced_watchdog = -1;  ///< fixed watchdog setting

  std::vector<std::string> heard;  ///< every line, as received
  int resumed = 0;                 ///< number of watchdog stops ended by a non-zero command

  void write(const std::string& bytes, int64_t now) {
    now_ = now;
    expire();
    for (const char byte : bytes) {
      if (deaf) continue;
      if (echo_ && !mute) output_ += byte;
      if (byte == '\r' || byte == '_') {
        serve(line_);
        line_.clear();
      } else if (byte >= ' ') {
        line_ += byte;
      }
    }
  }
  std::string read() {
    std::string output;
    output.swap(output_);
    return output;
  }
  void powerCycle() {
    echo_ = true;
    watchdog_ms_ = 1000;
    motor_1_ = motor_2_ = 0;
    expired_ = false;
    line_.clear();
    output_.clear();
  }
  int motor1(int64_t now) { return running(now) ? motor_1_ : 0; }
  int motor2(int64_t now) { return running(now) ? motor_2_ : 0; }
  bool stands(int64_t now) { return motor1(now) == 0 && motor2(now) == 0; }
  long watchdog() const { return watchdog_ms_; }
  bool echo() const { return echo_; }

 private:
  bool running(int64_t now) {
    now_ = now > now_ ? now : now_;
    expire();
    return !expired_ && (fault_flags & 16) == 0;
  }
  void expire() { expired_ = expired_ || (watchdog_ms_ > 0 && now_ - fed_ > watchdog_ms_ * 1000); }

  void reply(const std::string& text) {
    if (mute || (mute_plus && text == "+")) return;
    if (lose > 0) {
      --lose;
    } else if (cut > 0) {
      --cut;
      output_ += text.substr(0, text.size() / 2);
    } else {
      output_ += text + "\r";
    }
  }
  void serve(const std::string& line) {
    heard.push_back(line);
    int a = 0;
    int b = 0;
    if (line[0] == '!' && refuse > 0) {
      --refuse;
      reply("-");
    } else if (std::sscanf(line.c_str(), "!M %d %d", &a, &b) == 2) {
      move(a, b);
    } else if (std::sscanf(line.c_str(), "!G 1 %d", &a) == 1) {
      move(a, motor_2_);
    } else if (std::sscanf(line.c_str(), "!G 2 %d", &a) == 1) {
      move(motor_1_, a);
    } else if (line == "!EX") {
      fault_flags |= 16;
      move(0, 0);
    } else if (line == "!MG") {
      fault_flags &= ~16;
      move(motor_1_, motor_2_);
    } else {
      serveOther(line);
    }
  }
  void move(int a, int b) {
    resumed += expired_ && (a != 0 || b != 0);
    motor_1_ = a;
    motor_2_ = b;
    fed_ = now_;
    expired_ = false;
    reply("+");
  }
  void serveOther(const std::string& line) {
    long number = 0;
    if (std::sscanf(line.c_str(), "^ECHOF %ld", &number) == 1) {
      echo_ = number == 0;
      reply("+");
    } else if (std::sscanf(line.c_str(), "^RWD %ld", &number) == 1) {
      watchdog_ms_ = forced_watchdog < 0 ? number : forced_watchdog;
      fed_ = now_;
      reply("+");
    } else if (line == "~RWD") {
      reply("RWD=" + std::to_string(watchdog_ms_));
    } else if (line == "?FID") {
      reply("FID=Roboteq v1.8d SDC2130 06/03/2018");
    } else if (line == "?A") {
      reply("A=12:-7");
    } else if (line == "?V") {
      reply("V=135:246:4730");
    } else if (line == "?S") {
      reply("S=100:-50");
    } else if (line == "?T") {
      reply("T=31:40:38");
    } else if (line == "?FM") {
      reply("FM=0:0");
    } else if (line == "?FF") {
      reply("FF=" + std::to_string(fault_flags));
    } else if (line == "?FS") {
      reply("FS=" + std::to_string(status_flags));
    } else {
      reply("-");
    }
  }

  bool echo_ = true;
  long watchdog_ms_ = 1000;
  int motor_1_ = 0;
  int motor_2_ = 0;
  bool expired_ = false;
  int64_t now_ = 0;
  int64_t fed_ = 0;
  std::string line_;
  std::string output_;
};

}  // namespace tread::motor
