// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/types/renewal.hpp"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "common/execution/stop_reason.hpp"
#include "common/types/message_json.hpp"

namespace tread {

/// The .lcm files of each folder of lcmtypes/before; made by the build.
extern const char* const kTypesBefore[];

namespace {

using Json = nlohmann::json;

const std::string kCode = "_code";

const std::vector<MessageTypes>& typesBefore() {
  static const std::vector<MessageTypes> types = [] {
    std::vector<MessageTypes> read;
    for (const char* const* text = kTypesBefore; *text != nullptr; ++text)
      read.push_back(MessageTypes::fromText(*text));
    return read;
  }();
  return types;
}

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

Json unknownOf(const MessageField& field, const Json& message);

/// A message of a type with what is known of it.
void fillMissing(Json& message, const MessageType& type) {
  for (const MessageField& field : type.fields) {
    const auto member = message.find(field.name);
    if (member == message.end()) {
      message[field.name] = unknownOf(field, message);
      continue;
    }
    const MessageType* const inner = treadTypes().find(field.type);
    if (inner == nullptr) continue;
    if (member->is_object()) fillMissing(*member, *inner);
    if (member->is_array())
      for (Json& each : *member) fillMissing(each, *inner);
  }
}

/// The words that stand beside a code: state_code has state_reason, reason_code has reason.
StopReason codeBeside(const std::string& field, const Json& message) {
  const std::string stem = field.substr(0, field.size() - kCode.size());
  for (const std::string& name : {stem + "_reason", stem}) {
    const auto words = message.find(name);
    if (words != message.end() && words->is_string())
      return stopReasonOf(words->get<std::string>());
  }
  return StopReason::kUnsaid;
}

/// Of a field that a message does not have. An array whose length is a field is new with it: empty.
Json unknownOf(const MessageField& field, const Json& message) {
  if (field.type == "byte" && !field.lengths.empty()) return "";
  Json value = 0;
  if (const MessageType* const inner = treadTypes().find(field.type)) {
    value = Json::object();
    fillMissing(value, *inner);
  } else if (field.type == "string") {
    value = "";
  } else if (field.type == "boolean") {
    value = false;
  } else if (field.type == "float" || field.type == "double") {
    value = "NaN";
  } else if (endsWith(field.name, kCode)) {
    value = static_cast<int>(codeBeside(field.name, message));
  }
  if (field.lengths.empty()) return value;
  size_t count = 1;
  for (const std::string& length : field.lengths)
    count *= static_cast<size_t>(std::max(0, std::atoi(length.c_str())));  // 0 for a field's name
  return Json(count, value);
}

}  // namespace

bool renewByNames(const std::string& channel, std::vector<uint8_t>& bytes) {
  for (const MessageTypes& types : typesBefore()) {
    const MessageType* const older = types.typeOf(bytes);
    const MessageType* const type = older == nullptr ? nullptr : typeOfChannel(channel);
    if (type == nullptr || older->name != type->name) continue;
    const std::optional<std::string> text = jsonOf(types, *older, bytes);
    if (!text) return false;
    Json message = Json::parse(*text);
    fillMissing(message, *type);
    try {
      bytes = bytesOf(treadTypes(), *type, message.dump());
    } catch (const std::invalid_argument&) {
      return false;  // as any bytes that are no message
    }
    return true;
  }
  return false;
}

}  // namespace tread
