// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Replaces a process of the robot: accepts the same options, does nothing, and ends on request.
// Its configuration is one word: "good", "wrong" (its --check fails), "deaf" (never ends by
// itself), "brief" (ends at once), "mute" (gives no sign of life), "hangs" (gives none after 1.5
// s), "stubborn" (the same, and only SIGKILL ends it), "slow" (takes 1.5 s to end).
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include <sys/prctl.h>
#include <unistd.h>

#include "common/bus/host_clock.hpp"
#include "common/bus/life_sign.hpp"

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  std::string nature = "good";
  bool check = false;
  bool with_parent = false;
  for (size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "--config" && i + 1 < words.size()) std::ifstream(words[i + 1]) >> nature;
    check |= words[i] == "--check";
    with_parent |= words[i] == "--with-parent";
  }
  if (check) {
    if (nature == "wrong") std::puts("planner.yaml:3: lease is 9 s; allowed 0.05..1 s");
    return nature == "wrong" ? 1 : 0;
  }
  if (nature == "brief") return 4;
  const bool hangs = nature == "hangs" || nature == "stubborn";
  if (nature == "stubborn") std::signal(SIGABRT, SIG_IGN);
  if (with_parent) prctl(PR_SET_PDEATHSIG, SIGINT);
  sigset_t waited;
  sigemptyset(&waited);
  sigaddset(&waited, SIGINT);
  sigaddset(&waited, SIGTERM);
  sigprocmask(SIG_BLOCK, &waited, nullptr);
  for (const std::string& word : words) std::printf("%s ", word.c_str());
  std::printf("\nruns as %d in %s\n", getpid(), getcwd(nullptr, 0));
  std::fflush(stdout);
  tread::LifeSign life;
  const timespec patience{0, 50'000'000};
  const int64_t start = tread::hostNow();
  int number = -1;
  while (number < 0 || nature == "deaf") {
    const int64_t now = tread::hostNow();
    if (nature != "mute" && !(hangs && now > start + 1'500'000)) life.beat(now);
    number = sigtimedwait(&waited, nullptr, &patience);
  }
  life.stopping();
  if (nature == "slow") usleep(1'500'000);
  std::printf("ends by signal %d\n", number);
  return 0;
}
