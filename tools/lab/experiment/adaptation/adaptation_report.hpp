// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/lab/experiment/adaptation/adaptation.hpp"

namespace tread::adaptation {

/// Description of a run, for texts.
struct Report {
  std::string source;
  Settings settings;
  std::vector<std::string> notes;
  AdaptationErrors errors;
  std::vector<SummaryLine> lines;
};

/// Tables for the terminal.
std::string textOf(const Report& report);
/// adaptation.csv: a row per Line. sessions.csv: a row per session, rule, k and horizon.
std::string csvOfLines(const Report& report);
std::string csvOfSessions(const Report& report);
/// Writes adaptation.html, adaptation.png and the CSV files into a folder that exists.
void writeReport(const std::string& folder, const Report& report);

}  // namespace tread::adaptation
