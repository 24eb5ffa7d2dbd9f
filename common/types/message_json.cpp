// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/types/message_json.hpp"

#include <sodium.h>

#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "common/report/text.hpp"

namespace tread {
namespace {

using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;

template <class Number>
void appendNumber(std::string& out, Number value) {
  char digits[32];
  const auto end = std::to_chars(std::begin(digits), std::end(digits), value).ptr;
  out.append(digits, end);
}

void appendReal(std::string& out, double value, bool single) {
  if (std::isnan(value))
    out += "\"NaN\"";
  else if (std::isinf(value))
    out += value > 0.0 ? "\"Infinity\"" : "\"-Infinity\"";
  else if (value == 0.0)
    out += std::signbit(value) ? "-0.0" : "0";  // "-0" is read as the integer 0
  else if (single)
    appendNumber(out, static_cast<float>(value));
  else
    appendNumber(out, value);
}

/// Bytes that are no UTF-8 become the replacement character: JSON allows nothing else.
void appendText(std::string& out, const std::string& text) {
  out += Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Writes JSON without a tree in memory, because it dominates the time of an export.
class JsonWriter : public MessageVisitor {
 public:
  void beginField(const MessageField& field, size_t) override {
    comma();
    out += '"';
    out += field.name;
    out += "\":";
    bytes_ = isBytes(field) ? &gathered_ : nullptr;
    gathered_.clear();
    if (!field.lengths.empty() && bytes_ == nullptr) out += '[';
    first_ = true;
    boolean_ = field.type == "boolean";
  }
  void endField(const MessageField& field) override {
    if (bytes_ != nullptr)
      out += '"' + base64(gathered_) + '"';
    else if (!field.lengths.empty())
      out += ']';
    bytes_ = nullptr;
    first_ = false;
  }
  void integer(int64_t value) override {
    if (bytes_ != nullptr) {
      bytes_->push_back(static_cast<char>(value));
      return;
    }
    comma();
    if (boolean_)
      out += value != 0 ? "true" : "false";
    else
      appendNumber(out, value);
  }
  void real(double value, bool single) override {
    comma();
    appendReal(out, value, single);
  }
  void text(const std::string& value) override {
    comma();
    appendText(out, value);
  }
  void beginMessage(const MessageType&) override {
    comma();
    out += '{';
    first_ = true;
  }
  void endMessage(const MessageType&) override {
    out += '}';
    first_ = false;
  }
  static bool isBytes(const MessageField& field) {
    return field.type == "byte" && !field.lengths.empty();
  }

  std::string out;

 private:
  void comma() {
    if (!first_) out += ',';
    first_ = false;
  }

  bool first_ = true;
  bool boolean_ = false;
  std::string gathered_;
  std::string* bytes_ = nullptr;  ///< destination of bytes that become one text
};

/// Reads a message's JSON into its bytes.
class Encoder {
 public:
  explicit Encoder(const MessageTypes& types) : types_(types) {}

  void fingerprint(uint64_t value) { bigEndian(value, 8); }

  void message(const MessageType& type, const Json& json, const std::string& where) {
    if (!json.is_object()) fail(where, "is no object");
    std::map<std::string, int64_t> lengths;
    for (const MessageField& field : type.fields) {
      const std::string name = where.empty() ? field.name : where + "." + field.name;
      const auto found = json.find(field.name);
      if (found == json.end()) fail(name, "is missing");
      if (field.lengths.empty()) {
        value(field.type, *found, name);
        if (found->is_number_integer()) lengths[field.name] = found->get<int64_t>();
      } else {
        array(field, *found, countOf(field, lengths, name), name);
      }
    }
  }

  std::vector<uint8_t> bytes;

 private:
  [[noreturn]] static void fail(const std::string& where, const std::string& what) {
    throw std::invalid_argument((where.empty() ? "the message" : where) + " " + what);
  }

  static size_t countOf(const MessageField& field, const std::map<std::string, int64_t>& lengths,
                        const std::string& where) {
    size_t count = 1;
    for (const std::string& length : field.lengths) {
      const auto named = lengths.find(length);
      const int64_t size = named != lengths.end() ? named->second : std::stoll(length);
      if (size < 0 || size > std::numeric_limits<int32_t>::max())
        fail(where, "has an impossible length");
      count *= static_cast<size_t>(size);
    }
    return count;
  }

  void array(const MessageField& field, const Json& json, size_t count, const std::string& where) {
    if (JsonWriter::isBytes(field)) return raw(json, count, where);
    if (!json.is_array()) fail(where, "is no array");
    if (json.size() != count)
      fail(where,
           "has " + std::to_string(json.size()) + " values instead of " + std::to_string(count));
    for (const Json& item : json) value(field.type, item, where);
  }

  void raw(const Json& json, size_t count, const std::string& where) {
    if (!json.is_string()) fail(where, "is no base64 text");
    const auto& text = json.get_ref<const std::string&>();
    std::vector<uint8_t> data(text.size());
    size_t size = 0;
    if (sodium_base642bin(data.data(), data.size(), text.data(), text.size(), nullptr, &size,
                          nullptr, sodium_base64_VARIANT_ORIGINAL) != 0)
      fail(where, "is no base64 text");
    if (size != count)
      fail(where, "has " + std::to_string(size) + " bytes instead of " + std::to_string(count));
    bytes.insert(bytes.end(), data.begin(), data.begin() + static_cast<long>(size));
  }

  void value(const std::string& type, const Json& json, const std::string& where) {
    if (type == "string") return string(json, where);
    if (type == "float" || type == "double") return real(type, json, where);
    if (type == "boolean" && json.is_boolean()) return bigEndian(json.get<bool>() ? 1 : 0, 1);
    if (const MessageType* const inner = types_.find(type)) return message(*inner, json, where);
    if (!json.is_number_integer()) fail(where, "is no integer");
    integer(type, json.get<int64_t>(), where);
  }

  void integer(const std::string& type, int64_t number, const std::string& where) {
    const auto within = [&](int64_t least, int64_t most) {
      if (number < least || number > most) fail(where, "does not fit into " + type);
    };
    if (type == "int64_t") return bigEndian(static_cast<uint64_t>(number), 8);
    if (type == "int32_t") {
      within(INT32_MIN, INT32_MAX);
      return bigEndian(static_cast<uint64_t>(number), 4);
    }
    if (type == "int16_t") {
      within(INT16_MIN, INT16_MAX);
      return bigEndian(static_cast<uint64_t>(number), 2);
    }
    if (type == "int8_t")
      within(INT8_MIN, INT8_MAX);
    else
      within(0, UINT8_MAX);
    bigEndian(static_cast<uint64_t>(number), 1);
  }

  void string(const Json& json, const std::string& where) {
    if (!json.is_string()) fail(where, "is no text");
    const auto& text = json.get_ref<const std::string&>();
    bigEndian(text.size() + 1, 4);
    bytes.insert(bytes.end(), text.begin(), text.end());
    bytes.push_back(0);
  }

  static double numberOf(const Json& json, const std::string& where) {
    if (json.is_number()) return json.get<double>();
    if (json == "NaN" || json.is_null()) return std::numeric_limits<double>::quiet_NaN();
    if (json == "Infinity") return std::numeric_limits<double>::infinity();
    if (json == "-Infinity") return -std::numeric_limits<double>::infinity();
    fail(where, "is no number");
  }

  void real(const std::string& type, const Json& json, const std::string& where) {
    const double number = numberOf(json, where);
    if (type == "double") return bits<double, uint64_t>(number, 8);
    bits<float, uint32_t>(static_cast<float>(number), 4);
  }
  template <class Real, class Bits>
  void bits(Real real, size_t size) {
    Bits value;
    std::memcpy(&value, &real, sizeof value);
    bigEndian(value, size);
  }

  void bigEndian(uint64_t value, size_t size) {
    for (size_t i = size; i-- > 0;) bytes.push_back(static_cast<uint8_t>(value >> (8 * i)));
  }

  const MessageTypes& types_;
};

OrderedJson schemaOf(const MessageTypes& types, const MessageType& type);

OrderedJson schemaOfValue(const MessageTypes& types, const std::string& type) {
  if (const MessageType* const inner = types.find(type)) return schemaOf(types, *inner);
  if (type == "string" || type == "boolean") return {{"type", type}};
  return {{"type", type == "float" || type == "double" ? "number" : "integer"}};
}

OrderedJson schemaOfField(const MessageTypes& types, const MessageField& field) {
  OrderedJson schema;
  std::string comment = field.comment;
  if (JsonWriter::isBytes(field)) {
    schema = {{"type", "string"}, {"contentEncoding", "base64"}};
  } else if (field.lengths.empty()) {
    schema = schemaOfValue(types, field.type);
  } else {
    schema = {{"type", "array"}, {"items", schemaOfValue(types, field.type)}};
    if (field.lengths.size() > 1) {
      std::string shape;
      for (const std::string& length : field.lengths)
        shape += (shape.empty() ? "" : " x ") + length;
      comment += (comment.empty() ? "" : "; ") + shape + ", the last fastest";
    }
  }
  if (!comment.empty()) schema["description"] = comment;
  return schema;
}

OrderedJson schemaOf(const MessageTypes& types, const MessageType& type) {
  OrderedJson properties = OrderedJson::object();
  OrderedJson required = OrderedJson::array();
  for (const MessageField& field : type.fields) {
    properties[field.name] = schemaOfField(types, field);
    required.push_back(field.name);
  }
  std::string comment = type.comment;
  for (const MessageConstant& constant : type.constants) {
    comment += (comment.empty() ? "" : " ") + constant.name + " = " + constant.value;
    if (!constant.comment.empty()) comment += " (" + constant.comment + ")";
    comment += '.';
  }
  OrderedJson schema{{"title", "tread." + type.name}, {"type", "object"}};
  if (!comment.empty()) schema["description"] = comment;
  schema["properties"] = properties;
  schema["required"] = required;
  return schema;
}

}  // namespace

std::optional<std::string> jsonOf(const MessageTypes& types, const MessageType& type,
                                  const std::vector<uint8_t>& bytes) {
  JsonWriter writer;
  writer.out.reserve(2 * bytes.size() + 256);
  writer.beginMessage(type);
  if (!visit(types, type, bytes, writer)) return std::nullopt;
  writer.endMessage(type);
  return std::move(writer.out);
}

std::vector<uint8_t> bytesOf(const MessageTypes& types, const MessageType& type,
                             const std::string& json) {
  Encoder encoder(types);
  encoder.fingerprint(types.fingerprint(type));
  Json parsed;
  try {
    parsed = Json::parse(json);
  } catch (const Json::exception&) {
    throw std::invalid_argument("the message is no JSON");
  }
  encoder.message(type, parsed, "");
  return std::move(encoder.bytes);
}

std::string jsonSchemaOf(const MessageTypes& types, const MessageType& type) {
  return schemaOf(types, type).dump();
}

}  // namespace tread
