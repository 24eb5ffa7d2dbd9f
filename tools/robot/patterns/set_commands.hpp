// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

namespace tread::patterns {

CLI::App* addMake(CLI::App& app);
CLI::App* addShow(CLI::App& app);
CLI::App* addCheck(CLI::App& app);
CLI::App* addMirror(CLI::App& app);

}  // namespace tread::patterns
