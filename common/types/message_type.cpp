// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/types/message_type.hpp"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <regex>
#include <stdexcept>
#include <utility>

namespace tread {
namespace {

constexpr size_t kFingerprintBytes = 8;

/// Bytes of a value; 0 = its size varies.
size_t sizeOfPrimitive(const std::string& type) {
  static const std::map<std::string, size_t> sizes = {
      {"boolean", 1}, {"byte", 1},  {"int8_t", 1}, {"int16_t", 2}, {"int32_t", 4},
      {"int64_t", 8}, {"float", 4}, {"double", 8}, {"string", 0}};
  const auto found = sizes.find(type);
  return found == sizes.end() ? 0 : found->second;
}

bool isPrimitive(const std::string& type) {
  return type == "string" || sizeOfPrimitive(type) > 0;
}

bool isNumber(const std::string& word) {
  return !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char letter) {
    return std::isdigit(letter) != 0;
  });
}

struct Token {
  enum class Kind { kWord, kSign, kComment, kEnd } kind = Kind::kEnd;
  std::string text;
  int line = 0;
  bool apart = false;  ///< a comment in the place of a field
};

/// Splits .lcm files into words, symbols and comments.
class Lexer {
 public:
  explicit Lexer(const std::string& text) : text_(text) {}

  Token next() {
    skipSpace();
    Token token;
    token.line = line_;
    token.apart = at_ - line_begin_ <= kFieldColumn && first_;
    first_ = false;
    if (at_ >= text_.size()) return token;
    if (text_.compare(at_, 2, "//") == 0) return comment(token, text_.find('\n', at_), 2);
    if (text_.compare(at_, 2, "/*") == 0) {
      const size_t end = text_.find("*/", at_);
      return comment(token, end == std::string::npos ? end : end + 2, 2);
    }
    const auto wordLetter = [](unsigned char letter) {
      return std::isalnum(letter) != 0 || letter == '_' || letter == '.' || letter == '-' ||
             letter == '+';
    };
    const size_t begin = at_;
    while (at_ < text_.size() && wordLetter(static_cast<unsigned char>(text_[at_]))) ++at_;
    token.kind = at_ > begin ? Token::Kind::kWord : Token::Kind::kSign;
    if (at_ == begin) ++at_;
    token.text = text_.substr(begin, at_ - begin);
    return token;
  }

 private:
  static constexpr size_t kFieldColumn = 8;

  void skipSpace() {
    for (; at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0; ++at_)
      if (text_[at_] == '\n') {
        ++line_;
        first_ = true;
        line_begin_ = at_ + 1;
      }
  }
  Token comment(Token token, size_t end, size_t mark) {
    end = std::min(end, text_.size());
    token.kind = Token::Kind::kComment;
    token.text = text_.substr(at_ + mark, end - at_ - mark);
    const size_t begin = token.text.find_first_not_of(" *");
    token.text = begin == std::string::npos ? "" : token.text.substr(begin);
    while (!token.text.empty() && std::strchr(" */\r", token.text.back()) != nullptr)
      token.text.pop_back();
    line_ += static_cast<int>(std::count(text_.begin() + static_cast<long>(at_),
                                         text_.begin() + static_cast<long>(end), '\n'));
    at_ = end;
    return token;
  }

  const std::string& text_;
  size_t at_ = 0;
  int line_ = 1;
  bool first_ = true;  ///< nothing read from this line yet
  size_t line_begin_ = 0;
};

/// Parses structs; package names are ignored, because Tread's type names are unique.
class Parser {
 public:
  explicit Parser(const std::string& text) : lexer_(text) { advance(); }

  std::map<std::string, MessageType> types() {
    std::map<std::string, MessageType> types;
    while (token_.kind != Token::Kind::kEnd) {
      const std::string word = take("struct");
      if (word == "package") {
        take("a package's name");
        sign(";");
      } else if (word == "struct") {
        MessageType type = structure();
        types[type.name] = std::move(type);
      } else {
        fail("expected struct");
      }
    }
    return types;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw std::invalid_argument("message type, line " + std::to_string(token_.line) + ": " + what +
                                ", not '" + token_.text + "'");
  }

  /// Assigns comments: after a field and on the lines below it, to the field, else to the next
  /// struct.
  void advance() {
    for (;;) {
      token_ = lexer_.next();
      if (token_.kind != Token::Kind::kComment) break;
      std::string& target = comment_ != nullptr && !token_.apart ? *comment_ : before_;
      target += (target.empty() ? "" : " ") + token_.text;
    }
  }
  std::string take(const char* what) {
    if (token_.kind != Token::Kind::kWord) fail(std::string("expected ") + what);
    std::string word = token_.text;
    advance();
    return word;
  }
  bool isSign(const char* wanted) const {
    return token_.kind == Token::Kind::kSign && token_.text == wanted;
  }
  void sign(const char* wanted) {
    if (!isSign(wanted)) fail(std::string("expected ") + wanted);
    advance();
  }
  /// A symbol after which comments belong to `comment`.
  void signBefore(const char* wanted, std::string* comment) {
    if (!isSign(wanted)) fail(std::string("expected ") + wanted);
    comment_ = comment;
    advance();
    comment_ = nullptr;
  }

  MessageType structure() {
    MessageType type;
    type.comment = std::exchange(before_, "");
    type.name = take("a struct's name");
    sign("{");
    while (!isSign("}")) {
      if (token_.text == "const")
        constants(type);
      else
        field(type);
    }
    before_.clear();
    advance();
    return type;
  }

  void constants(MessageType& type) {
    static const std::regex named("enum ([A-Za-z]+)(: bits)?");
    if (std::smatch match; std::regex_match(before_, match, named)) {
      type.enumeration = match[1];
      type.is_bit_set = match[2].matched;
    }
    before_.clear();
    advance();
    const std::string value_type = take("a constant's type");
    for (bool more = true; more;) {
      MessageConstant constant;
      constant.type = value_type;
      constant.name = take("a constant's name");
      sign("=");
      constant.value = take("a constant's value");
      more = isSign(",");
      type.constants.push_back(std::move(constant));
      signBefore(more ? "," : ";", &type.constants.back().comment);
    }
  }

  void field(MessageType& type) {
    MessageField field;
    field.type = take("a field's type");
    if (const size_t dot = field.type.rfind('.'); dot != std::string::npos)
      field.type.erase(0, dot + 1);
    for (bool more = true; more;) {
      field.name = take("a field's name");
      field.lengths.clear();
      while (isSign("[")) {
        advance();
        field.lengths.push_back(take("a length"));
        sign("]");
      }
      more = isSign(",");
      type.fields.push_back(field);
      signBefore(more ? "," : ";", &type.fields.back().comment);
    }
  }

  Lexer lexer_;
  Token token_;
  std::string before_;              ///< comments for the next item
  std::string* comment_ = nullptr;  ///< where comments go now
};

/// lcm-gen's hash of a series of bytes.
class FieldHash {
 public:
  void add(uint64_t value) {
    // The algorithm right-shifts a signed number.
    const auto high = static_cast<uint64_t>(static_cast<int64_t>(value_) >> 55);
    value_ = ((value_ << 8) ^ high) + value;
  }
  void add(const std::string& text) {
    add(text.size());
    for (const char letter : text) add(static_cast<uint64_t>(letter));
  }
  uint64_t value() const { return value_; }

 private:
  uint64_t value_ = 0x12345678;
};

uint64_t bigEndian(const uint8_t* bytes, size_t size) {
  uint64_t value = 0;
  for (size_t i = 0; i < size; ++i) value = value << 8 | bytes[i];
  return value;
}

/// Walks through a message's bytes.
class Walk {
 public:
  Walk(const MessageTypes& types, const std::vector<uint8_t>& bytes, MessageVisitor& visitor)
      : types_(types), bytes_(bytes), visitor_(visitor), at_(kFingerprintBytes) {}

  bool message(const MessageType& type) {
    std::map<std::string, int64_t> lengths;
    for (const MessageField& field : type.fields) {
      const auto count = countOf(field, lengths);
      if (!count) return false;
      visitor_.beginField(field, *count);
      const bool integer = field.lengths.empty() && isPrimitive(field.type);
      for (size_t i = 0; i < *count; ++i)
        if (!value(field)) return false;
      if (integer) lengths[field.name] = last_;
      visitor_.endField(field);
    }
    return true;
  }
  bool atEnd() const { return at_ == bytes_.size(); }

 private:
  size_t rest() const { return bytes_.size() - at_; }

  /// Number of values of the field; each takes at least a byte, so that more than the remaining
  /// bytes is impossible.
  std::optional<size_t> countOf(const MessageField& field,
                                const std::map<std::string, int64_t>& lengths) const {
    size_t count = 1;
    for (const std::string& length : field.lengths) {
      const int64_t size = isNumber(length) ? std::stoll(length) : lengths.at(length);
      if (size < 0 || (size > 0 && count > rest() / static_cast<size_t>(size))) return std::nullopt;
      count *= static_cast<size_t>(size);
    }
    return count;
  }

  bool value(const MessageField& field) {
    if (!isPrimitive(field.type)) {
      const MessageType& inner = *types_.find(field.type);
      visitor_.beginMessage(inner);
      if (!message(inner)) return false;
      visitor_.endMessage(inner);
      return true;
    }
    if (field.type == "string") return string();
    const size_t size = sizeOfPrimitive(field.type);
    if (rest() < size) return false;
    number(field.type, bigEndian(bytes_.data() + at_, size));
    at_ += size;
    return true;
  }

  bool string() {
    if (rest() < 4) return false;
    const uint64_t size = bigEndian(bytes_.data() + at_, 4);
    at_ += 4;
    if (size < 1 || size > rest()) return false;
    const char* const begin = reinterpret_cast<const char*>(bytes_.data() + at_);
    visitor_.text(std::string(begin, strnlen(begin, size - 1)));
    at_ += size;
    return true;
  }

  template <class Real, class Bits>
  static double realOf(uint64_t value) {
    const auto bits = static_cast<Bits>(value);
    Real real;
    std::memcpy(&real, &bits, sizeof real);
    return static_cast<double>(real);
  }

  void number(const std::string& type, uint64_t value) {
    if (type == "float") return visitor_.real(realOf<float, uint32_t>(value), true);
    if (type == "double") return visitor_.real(realOf<double, uint64_t>(value), false);
    if (type == "int64_t")
      last_ = static_cast<int64_t>(value);
    else if (type == "int32_t")
      last_ = static_cast<int32_t>(value);
    else if (type == "int16_t")
      last_ = static_cast<int16_t>(value);
    else if (type == "int8_t")
      last_ = static_cast<int8_t>(value);
    else
      last_ = static_cast<int64_t>(value);  // byte, boolean
    visitor_.integer(last_);
  }

  const MessageTypes& types_;
  const std::vector<uint8_t>& bytes_;
  MessageVisitor& visitor_;
  size_t at_;
  int64_t last_ = 0;  ///< the newest integer
};

/// Collects numbers by field name.
class Numbers : public MessageVisitor {
 public:
  void beginField(const MessageField& field, size_t) override { now_ = &numbers[field.name]; }
  void endField(const MessageField&) override {}
  void integer(int64_t value) override { now_->push_back(static_cast<double>(value)); }
  void real(double value, bool) override { now_->push_back(value); }
  void text(const std::string&) override { only_numbers = false; }
  void beginMessage(const MessageType&) override { only_numbers = false; }
  void endMessage(const MessageType&) override {}

  std::map<std::string, std::vector<double>> numbers;
  bool only_numbers = true;

 private:
  std::vector<double>* now_ = nullptr;
};

}  // namespace

const MessageField* MessageType::field(const std::string& wanted) const {
  const auto found = std::find_if(fields.begin(), fields.end(), [&](const MessageField& candidate) {
    return candidate.name == wanted;
  });
  return found == fields.end() ? nullptr : &*found;
}

int64_t blankInteger(const MessageField& field) {
  static const std::regex blank("; (blank )?(-?[0-9]+)( |;|$)");
  for (std::sregex_iterator match(field.comment.begin(), field.comment.end(), blank), end;
       match != end; ++match)
    if ((*match)[1].matched || (*match)[2] == "-1") return std::stoll((*match)[2]);
  return 0;
}

MessageTypes MessageTypes::fromText(const std::string& text) {
  MessageTypes types;
  types.types_ = Parser(text).types();
  types.check();
  for (const auto& [name, type] : types.types_)
    types.by_fingerprint_[types.fingerprint(type)] = &type;
  return types;
}

void MessageTypes::check() const {
  for (const auto& [name, type] : types_)
    for (const MessageField& field : type.fields) {
      const std::string where = name + "." + field.name;
      if (!isPrimitive(field.type) && (find(field.type) == nullptr || field.type == name))
        throw std::invalid_argument(where + ": no type " + field.type);
      for (const std::string& length : field.lengths) {
        const MessageField* const other = type.field(length);
        const bool earlier = other != nullptr && other < &field && other->lengths.empty() &&
                             other->type.rfind("int", 0) == 0;
        if (!isNumber(length) && !earlier)
          throw std::invalid_argument(where + ": its length " + length +
                                      " is no number and no earlier integer field");
      }
    }
}

const MessageType* MessageTypes::find(const std::string& name) const {
  const auto found = types_.find(name);
  return found == types_.end() ? nullptr : &found->second;
}

uint64_t MessageTypes::fingerprint(const MessageType& type) const {
  FieldHash hash;
  uint64_t inner = 0;
  for (const MessageField& field : type.fields) {
    hash.add(field.name);
    if (isPrimitive(field.type))
      hash.add(field.type);
    else
      inner += fingerprint(*find(field.type));
    hash.add(field.lengths.size());
    for (const std::string& length : field.lengths) {
      hash.add(isNumber(length) ? 0 : 1);
      hash.add(length);
    }
  }
  const uint64_t whole = hash.value() + inner;
  return whole << 1 | whole >> 63;
}

const MessageType* MessageTypes::typeOf(const std::vector<uint8_t>& bytes) const {
  if (bytes.size() < kFingerprintBytes) return nullptr;
  const auto found = by_fingerprint_.find(bigEndian(bytes.data(), kFingerprintBytes));
  return found == by_fingerprint_.end() ? nullptr : found->second;
}

bool visit(const MessageTypes& types, const MessageType& type, const std::vector<uint8_t>& bytes,
           MessageVisitor& visitor) {
  if (bytes.size() < kFingerprintBytes ||
      bigEndian(bytes.data(), kFingerprintBytes) != types.fingerprint(type))
    return false;
  Walk walk(types, bytes, visitor);
  return walk.message(type) && walk.atEnd();
}

std::optional<std::map<std::string, std::vector<double>>> numbersOf(
    const MessageTypes& types, const MessageType& type, const std::vector<uint8_t>& bytes) {
  Numbers numbers;
  if (!visit(types, type, bytes, numbers) || !numbers.only_numbers) return std::nullopt;
  return std::move(numbers.numbers);
}

}  // namespace tread
