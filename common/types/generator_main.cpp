// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Runs while the house is built, after lcm-gen: writes what else follows from the .lcm files.
//     type-generator ENUMS TYPES BLANK FILE.lcm...
// Three headers: the enumerations in plain C++, for cores; the list of all types; the fields of a
// blank message.
#include <algorithm>
#include <cctype>
#include <exception>
#include <fstream>
#include <iostream>
#include <iterator>
#include <stdexcept>

#include "common/types/message_type.hpp"

namespace tread {
namespace {

/// NO_POSITION, from the second word on, as NoPosition.
std::string camelCase(const std::string& constant) {
  std::string camel;
  for (size_t i = constant.find('_') + 1; i < constant.size(); ++i) {
    const auto letter = static_cast<unsigned char>(constant[i]);
    const bool begins = camel.empty() || constant[i - 1] == '_';
    if (letter != '_') camel += static_cast<char>(begins ? letter : std::tolower(letter));
  }
  return camel;
}

std::string enumerators(const MessageType& type, const std::string& indent) {
  std::string text;
  for (const MessageConstant& constant : type.constants) {
    text += indent + "k" + camelCase(constant.name) + " = " + constant.value + ",";
    text += (constant.comment.empty() ? "" : "  ///< " + constant.comment) + "\n";
  }
  return text;
}

/// The bits are combined as integers.
std::string bitSet(const MessageType& type) {
  return "struct " + type.enumeration + " {\n  enum Bit : " + type.constants.front().type + " {\n" +
         enumerators(type, "    ") + "  };\n};\n";
}

std::string oneOf(const MessageType& type) {
  const std::string& name = type.enumeration;
  std::string text = "enum class " + name + " : " + type.constants.front().type + " {\n" +
                     enumerators(type, "  ") + "};\n\n";
  text += "/// The enumerator of a number; nullopt if there is none.\n";
  text += "inline std::optional<" + name + "> known" + name + "(int64_t number) {\n";
  text += "  switch (number) {\n";
  for (const MessageConstant& constant : type.constants)
    text += "    case " + constant.value + ":\n";
  return text + "      return static_cast<" + name + ">(number);\n" +
         "    default:\n      return std::nullopt;\n  }\n}\n";
}

std::string enumHeader(const MessageTypes& types) {
  std::string text =
      "#pragma once\n\n#include <cstdint>\n#include <optional>\n\nnamespace tread {\n\n";
  for (const auto& [name, type] : types.all()) {
    if (type.constants.empty()) continue;
    if (type.enumeration.empty())
      throw std::invalid_argument(name + ": write '// enum NAME' in front of its constants");
    text +=
        "/// Constants of " + name + ".\n" + (type.is_bit_set ? bitSet(type) : oneOf(type)) + "\n";
  }
  return text + "}  // namespace tread\n";
}

std::string listHeader(const MessageTypes& types) {
  std::string text = "#pragma once\n\n#include <tuple>\n\n";
  std::string list;
  for (const auto& [name, type] : types.all()) {
    text += "#include <tread/" + name + ".hpp>\n";
    list += (list.empty() ? "" : ", ") + name;
  }
  return text + "\nnamespace tread {\n\n/// Sorted by name.\nusing AllMessages = std::tuple<" +
         list + ">;\n\n}  // namespace tread\n";
}

/// What sets a field to "unknown" if that is not 0, false or empty.
std::string unknownField(const MessageTypes& types, const MessageField& field) {
  const auto isNumber = [](const std::string& length) {
    return std::isdigit(static_cast<unsigned char>(length[0])) != 0;
  };
  // A vector is empty.
  if (!std::all_of(field.lengths.begin(), field.lengths.end(), isNumber)) return "";
  std::string value;
  if (types.find(field.type) != nullptr && field.lengths.empty())
    return "  markUnknown(m." + field.name + ");\n";
  if (field.type == "float" || field.type == "double")
    value = "std::numeric_limits<" + field.type + ">::quiet_NaN()";
  else if (field.type.rfind("int", 0) == 0 && blankInteger(field) != 0)
    value = std::to_string(blankInteger(field));
  if (value.empty()) return "";
  if (field.lengths.size() > 1)
    throw std::invalid_argument(field.name + ": arrays of constant sizes have one dimension");
  if (field.lengths.empty()) return "  m." + field.name + " = " + value + ";\n";
  return "  for (auto& value : m." + field.name + ") value = " + value + ";\n";
}

std::string unknownHeader(const MessageTypes& types) {
  std::string text =
      "#pragma once\n\n#include <limits>\n\n#include <tread/message_list.hpp>\n\n"
      "namespace tread::detail {\n\n";
  std::string definitions;
  for (const auto& [name, type] : types.all()) {
    std::string body;
    for (const MessageField& field : type.fields) body += unknownField(types, field);
    const std::string head = "inline void markUnknown(" + name + "&";
    text += head + ");\n";
    definitions += "\n" + head + (body.empty() ? "" : " m") + ") {\n" + body + "}\n";
  }
  return text + definitions + "\n}  // namespace tread::detail\n";
}

/// A file that stays as it is keeps its time: nothing is built anew for it.
void write(const std::string& path, const std::string& text) {
  std::ifstream present(path);
  const std::string before((std::istreambuf_iterator<char>(present)), {});
  if (present.is_open() && before == text) return;
  std::ofstream file(path);
  if (!(file << text)) throw std::runtime_error("cannot write " + path);
}

}  // namespace
}  // namespace tread

int main(int argc, char** argv) {
  try {
    if (argc < 5) throw std::invalid_argument("needs ENUMS TYPES BLANK FILE.lcm...");
    std::string text;
    for (int i = 4; i < argc; ++i) {
      std::ifstream file(argv[i]);
      text.append(std::istreambuf_iterator<char>(file), {});
    }
    const auto types = tread::MessageTypes::fromText(text);
    tread::write(argv[1], tread::enumHeader(types));
    tread::write(argv[2], tread::listHeader(types));
    tread::write(argv[3], tread::unknownHeader(types));
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "type-generator: " << error.what() << "\n";
    return 1;
  }
}
