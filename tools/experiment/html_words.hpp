// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "tools/experiment/tables.hpp"

namespace tread::experiment {

/// What report.html begins with, up to the body.
extern const char* const kHtmlHead;

/// Letters that HTML reads as its own are written as entities.
std::string escaped(const std::string& text);
/// printf of one number.
std::string number(const char* format, double value);
/// A PNG within the page.
std::string picture(const std::string& png, const std::string& words);
/// One cell of a table; `tip` appears under the pointer.
std::string cell(const std::string& inside, const std::string& tip = "", bool group = false);
/// The paper's number, in grey, with the reason for a doubt under the pointer.
std::string paperWords(double value, const char* format, const std::string& doubt);
/// The interval of a number and its deviation.
std::string intervalWords(const Row& row, const char* format);

}  // namespace tread::experiment
