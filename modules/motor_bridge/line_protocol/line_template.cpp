// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/line_protocol/line_template.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <utility>

namespace tread::motor {
namespace {

constexpr double kLargest = 999'999'999.0;  // of a decimal number
constexpr size_t kLongestNumber = 20;

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

bool isName(const std::string& name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || c == '_' || isDigit(c);
  });
}

[[noreturn]] void refuse(const std::string& field, const std::string& problem) {
  throw std::invalid_argument("{" + field + "}: " + problem);
}

std::string filled(const std::string& digits, int width) {
  const size_t missing =
      std::max<size_t>(static_cast<size_t>(width), digits.size()) - digits.size();
  return std::string(missing, '0') + digits;
}

std::string hexadecimal(double value, bool two_complement, int width, bool capitals) {
  const int bits = width == 0 ? 32 : 4 * width;
  const double span = std::ldexp(1.0, std::min(bits, 32));
  const double low = two_complement ? -span / 2 : 0.0;
  const double high = two_complement ? span / 2 - 1 : span - 1;
  const auto clamped = static_cast<int64_t>(std::clamp(std::round(value), low, high));
  const auto bitsOf = static_cast<uint64_t>(clamped) & static_cast<uint64_t>(span - 1);
  std::array<char, 16> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), bitsOf, 16).ptr;
  std::string digits(buffer.data(), end);
  if (capitals)
    for (char& c : digits) c = static_cast<char>(c >= 'a' ? c - 'a' + 'A' : c);
  return filled(digits, width);
}

std::string decimal(double value, bool sign, int width, int digits) {
  const double clamped = std::clamp(value, -kLargest, kLargest);
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), std::abs(clamped),
                                 std::chars_format::fixed, digits)
                       .ptr;
  const std::string text(buffer.data(), end);
  const bool zero = text.find_first_not_of("0.") == std::string::npos;
  const std::string mark = clamped < 0.0 && !zero ? "-" : sign ? "+" : "";
  return mark + filled(text, width);
}

std::optional<double> hexadecimalFrom(std::string_view digits, bool two_complement, int width) {
  uint32_t bits = 0;
  const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), bits, 16);
  if (digits.empty() || read.ec != std::errc() || read.ptr != digits.data() + digits.size())
    return std::nullopt;
  const double span = std::ldexp(1.0, 4 * width);
  const auto value = static_cast<double>(bits);
  return two_complement && value >= span / 2 ? value - span : value;
}

}  // namespace

LineTemplate::LineTemplate(const std::string& text) : text_(text) {
  std::string literal;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c < ' ' || c > '~')
      throw std::invalid_argument("contains a character that is not printable");
    const bool twice = i + 1 < text.size() && text[i + 1] == c;
    if ((c == '{' || c == '}') && twice) {
      literal += c;
      ++i;
    } else if (c == '{') {
      const size_t end = text.find('}', i);
      if (end == std::string::npos) throw std::invalid_argument("a { without its }; {{ is a brace");
      pieces_.push_back(fieldOf(text.substr(i + 1, end - i - 1)));
      pieces_.back().literal = std::exchange(literal, {});
      i = end;
    } else if (c == '}') {
      throw std::invalid_argument("a } without its {; }} is a brace");
    } else {
      literal += c;
    }
  }
  if (!literal.empty()) pieces_.push_back({literal, "", 'd', false, 0, 0});
  for (size_t i = 0; i + 1 < pieces_.size(); ++i)
    if (pieces_[i + 1].literal.empty() && pieces_[i + 1].name != "" && pieces_[i].width == 0)
      throw std::invalid_argument("two numbers without anything between them");
}

LineTemplate::Piece LineTemplate::fieldOf(const std::string& field) {
  Piece piece;
  const size_t colon = field.find(':');
  piece.name = field.substr(0, colon);
  if (!isName(piece.name)) refuse(field, "a name has letters a-z, digits and _");
  if (colon == std::string::npos) return piece;
  std::string form = field.substr(colon + 1);
  const auto take = [&form](char c) {
    const bool there = !form.empty() && form[0] == c;
    if (there) form.erase(0, 1);
    return there;
  };
  const auto digit = [&form]() {
    if (form.empty() || !isDigit(form[0])) return -1;
    const int value = form[0] - '0';
    form.erase(0, 1);
    return value;
  };
  piece.sign = take('+');
  if (take('0')) piece.width = digit();
  if (take('.')) piece.digits = digit();
  const bool point = piece.digits > 0 || field.find('.') != std::string::npos;
  if (form.size() != 1 || piece.width < 0 || piece.digits < 0 ||
      std::string_view(point ? "f" : "dxX").find(form[0]) == std::string_view::npos)
    refuse(field, "the form must be [+][0WIDTH]d, [+][0WIDTH].Nf or [+][0WIDTH]x");
  piece.form = form[0];
  const bool hex = piece.form == 'x' || piece.form == 'X';
  if (hex && (piece.width > 8 || (piece.sign && piece.width == 0)))
    refuse(field, "a hexadecimal has at most 8 digits, and with + its WIDTH must be given");
  return piece;
}

std::string LineTemplate::written(const Piece& piece, double value) {
  const double finite = std::isfinite(value) ? value : 0.0;
  if (piece.form == 'x' || piece.form == 'X')
    return hexadecimal(finite, piece.sign, piece.width, piece.form == 'X');
  return decimal(piece.form == 'd' ? std::round(finite) : finite, piece.sign, piece.width,
                 piece.digits);
}

std::string LineTemplate::format(const LineValues& values) const {
  std::string line;
  for (const Piece& piece : pieces_) {
    line += piece.literal;
    if (piece.name.empty()) continue;
    const auto value = values.find(piece.name);
    line += written(piece, value == values.end() ? 0.0 : value->second);
  }
  return line;
}

std::optional<double> LineTemplate::readFrom(const Piece& piece, std::string_view& rest) {
  const bool hex = piece.form == 'x' || piece.form == 'X';
  const size_t sign = !hex && !rest.empty() && (rest[0] == '-' || rest[0] == '+') ? 1 : 0;
  size_t end = sign;
  const size_t most = hex && piece.width > 0 ? static_cast<size_t>(piece.width) : kLongestNumber;
  while (end < rest.size() && end - sign < most) {
    const char c = rest[end];
    const bool letter = (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
    if (!isDigit(c) && !(hex && letter) && !(piece.form == 'f' && c == '.')) break;
    ++end;
  }
  const std::string_view digits = rest.substr(sign, end - sign);
  const bool negative = sign == 1 && rest[0] == '-';
  rest.remove_prefix(end);
  if (hex) {
    if (piece.width > 0 && digits.size() != most) return std::nullopt;
    return hexadecimalFrom(digits, piece.sign, piece.width);
  }
  double value = 0.0;
  const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), value,
                                    std::chars_format::fixed);
  if (digits.empty() || read.ec != std::errc() || read.ptr != digits.data() + digits.size() ||
      value > kLargest)
    return std::nullopt;
  return negative ? -value : value;
}

std::optional<LineValues> LineTemplate::match(std::string_view line) const {
  LineValues values;
  for (size_t i = 0; i < pieces_.size(); ++i) {
    const Piece& piece = pieces_[i];
    if (line.substr(0, piece.literal.size()) != piece.literal) return std::nullopt;
    line.remove_prefix(piece.literal.size());
    if (piece.name == "_") {
      const std::string next = i + 1 < pieces_.size() ? pieces_[i + 1].literal : "";
      const size_t end = next.empty() ? line.size() : line.find(next);
      if (end == std::string_view::npos) return std::nullopt;
      line.remove_prefix(end);
    } else if (!piece.name.empty()) {
      const std::optional<double> value = readFrom(piece, line);
      if (!value) return std::nullopt;
      values[piece.name] = *value;
    }
  }
  return line.empty() ? std::optional(values) : std::nullopt;
}

std::vector<std::string> LineTemplate::names() const {
  std::vector<std::string> names;
  for (const Piece& piece : pieces_)
    if (!piece.name.empty() && piece.name != "_") names.push_back(piece.name);
  return names;
}

bool LineTemplate::has(const std::string& name) const {
  const std::vector<std::string> all = names();
  return std::find(all.begin(), all.end(), name) != all.end();
}

bool LineTemplate::takesNegative(const std::string& name) const {
  return std::all_of(pieces_.begin(), pieces_.end(), [&name](const Piece& piece) {
    return piece.name != name || piece.sign || (piece.form != 'x' && piece.form != 'X');
  });
}

bool LineTemplate::isWritable() const {
  return std::none_of(pieces_.begin(), pieces_.end(),
                      [](const Piece& piece) { return piece.name == "_"; });
}

}  // namespace tread::motor
