// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/report/text.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace tread {
namespace {

constexpr double kDegrees = 180.0 / 3.14159265358979323846;

struct FieldUnit {
  const char* unit;
  double factor;
  const char* said;
};

/// Units that are shown to users in another form.
const FieldUnit kFieldUnits[] = {{"1", 100.0, "%"},
                                 {"rad", kDegrees, "deg"},
                                 {"rad/m", kDegrees, "deg per metre"},
                                 {"1/h", 100.0, "% per hour"},
                                 {"s2/m2", 1.0, "s\u00b2/m\u00b2"},
                                 {"m/s2", 1.0, "m/s\u00b2"},
                                 {"s2/m", 1.0, "s\u00b2/m"},
                                 {"", 1.0, ""}};

FieldUnit fieldUnit(const std::string& unit) {
  for (const FieldUnit& candidate : kFieldUnits)
    if (unit == candidate.unit) return candidate;
  return {unit.c_str(), 1.0, unit.c_str()};
}

std::string withUnit(const std::string& number, const std::string& unit) {
  return unit.empty() || number == "no limit" ? number : number + " " + unit;
}

}  // namespace

std::string formatted(const char* format, ...) {
  va_list arguments, again;
  va_start(arguments, format);
  va_copy(again, arguments);
  const int size = std::vsnprintf(nullptr, 0, format, arguments);
  va_end(arguments);
  std::string text(static_cast<size_t>(std::max(0, size)) + 1, '\0');
  std::vsnprintf(text.data(), text.size(), format, again);
  va_end(again);
  text.pop_back();
  return text;
}

std::string threeDigits(double value) {
  if (std::isnan(value)) return "-";
  if (std::isinf(value)) return "no limit";
  const double whole = std::round(value);
  if (whole == 0.0 && std::abs(value) < 1e-12) return "0";
  if (std::abs(value - whole) < 1e-9 * std::abs(value) && std::abs(value) < 1e15)
    return std::to_string(static_cast<long long>(whole));
  const int order = static_cast<int>(std::floor(std::log10(std::abs(value))));
  const int decimals = std::clamp(2 - order, 0, 6);
  const std::string text = fixed(value, decimals);
  const bool zero = text.find_first_of("123456789") == std::string::npos;
  return zero ? formatted("%.2g", value) : text;
}

std::string said(double value, const std::string& unit) {
  const FieldUnit field = fieldUnit(unit);
  return withUnit(threeDigits(value * field.factor), field.said);
}

std::string saidInterval(double low, double high, const std::string& unit) {
  const FieldUnit field = fieldUnit(unit);
  return threeDigits(low * field.factor) + " to " + said(high, unit);
}

std::string saidAngle(double angle) {
  return said(angle, "rad");
}

std::string saidDistance(double distance) {
  return said(distance, "m");
}

std::string joined(const std::vector<std::string>& words, const std::string& joint) {
  std::string text;
  for (size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " " + joint + " " : ", ";
    text += words[i];
  }
  return text;
}

std::string joinedSentences(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences) text += (text.empty() ? "" : " ") + sentence;
  return text;
}

std::string withoutStop(const std::string& sentence) {
  return !sentence.empty() && sentence.back() == '.' ? sentence.substr(0, sentence.size() - 1)
                                                     : sentence;
}

std::string inSentence(const std::string& words) {
  // Abbreviations (INS, CANNOT) keep their capitals.
  if (words.size() < 2 || std::isupper(static_cast<unsigned char>(words[1])) != 0) return words;
  std::string text = words;
  text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  return text;
}

std::string asSentence(const std::string& words) {
  // Formulas keep their letters.
  if (words.size() > 1 && words[1] != ' ' &&
      std::islower(static_cast<unsigned char>(words[1])) == 0)
    return words;
  std::string text = words;
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

std::string saidChance(double p_value) {
  return p_value < 0.001 ? "below 0.001" : formatted("%.2g", p_value);
}

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char letter : text) {
    if (letter == '<')
      safe += "&lt;";
    else if (letter == '>')
      safe += "&gt;";
    else if (letter == '&')
      safe += "&amp;";
    else if (letter == '"')
      safe += "&quot;";
    else
      safe += letter;
  }
  return safe;
}

std::string base64(const std::string& bytes) {
  static const char kLetters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    unsigned group = 0;
    for (size_t j = 0; j < 3; ++j)
      group = group << 8 | (i + j < bytes.size() ? static_cast<unsigned char>(bytes[i + j]) : 0U);
    for (size_t j = 0; j < 4; ++j)
      text += i + j <= bytes.size() ? kLetters[group >> (18 - 6 * j) & 63U] : '=';
  }
  return text;
}

double tickStep(double range, int pieces) {
  const double rough = range / pieces;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= rough) return factor * power;
  return 10.0 * power;
}

std::vector<double> ticks(double low, double high, double step) {
  std::vector<double> all;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k += 1.0)
    all.push_back(k == 0.0 ? 0.0 : k * step);
  return all;
}

std::string tickText(double value, double step) {
  return fixed(value, std::clamp(static_cast<int>(-std::floor(std::log10(step) + 1e-9)), 0, 6));
}

}  // namespace tread
