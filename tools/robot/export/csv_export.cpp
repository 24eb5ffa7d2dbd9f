// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/export/csv_export.hpp"

#include <map>

#include <nlohmann/json.hpp>

#include "common/store/output_file.hpp"
#include "common/types/tread_types.hpp"
#include "tools/robot/export/log_selection.hpp"

namespace tread::exporting {
namespace {

using Json = nlohmann::json;

/// Number of values of a field of fixed length; 0 = variable length.
size_t fixedCount(const MessageField& field) {
  size_t count = 1;
  for (const std::string& length : field.lengths) {
    if (length.find_first_not_of("0123456789") != std::string::npos) return 0;
    count *= std::stoul(length);
  }
  return count;
}

/// A number or text has one column, a fixed array one column per value, a message one per field, a
/// variable array one in all.
enum class Layout { kOne, kEach, kMessage, kTogether };

Layout layoutOf(const MessageField& field) {
  const bool message = treadTypes().find(field.type) != nullptr;
  if (field.lengths.empty()) return message ? Layout::kMessage : Layout::kOne;
  const bool bytes = field.type == "byte";
  return message || bytes || fixedCount(field) == 0 ? Layout::kTogether : Layout::kEach;
}

void addNames(const MessageType& type, const std::string& prefix, std::string& row) {
  for (const MessageField& field : type.fields) {
    const std::string name = prefix + field.name;
    const Layout layout = layoutOf(field);
    if (layout == Layout::kMessage) {
      addNames(*treadTypes().find(field.type), name + ".", row);
    } else if (layout == Layout::kEach) {
      for (size_t i = 0; i < fixedCount(field); ++i)
        row += "," + name + "[" + std::to_string(i) + "]";
    } else {
      row += "," + name;
    }
  }
}

/// Quotes a text as a CSV cell (RFC 4180).
std::string cellOf(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string cell = "\"";
  for (const char letter : text) cell += letter == '"' ? "\"\"" : std::string(1, letter);
  return cell + '"';
}

std::string cellOf(const Json& value) {
  return cellOf(value.is_string() ? value.get<std::string>() : value.dump());
}

void addCells(const MessageType& type, const Json& message, std::string& row) {
  for (const MessageField& field : type.fields) {
    const Json& value = message.at(field.name);
    const Layout layout = layoutOf(field);
    if (layout == Layout::kMessage)
      addCells(*treadTypes().find(field.type), value, row);
    else if (layout == Layout::kEach)
      for (const Json& item : value) row += "," + cellOf(item);
    else
      row += "," + cellOf(value);
  }
}

/// One CSV file per channel in a folder.
class CsvExport {
 public:
  explicit CsvExport(const std::string& folder) : folder_(folder) {}

  void take(const LogEvent& event) {
    const auto message = countedJson(event, counts);
    if (!message) return;
    std::string row = std::to_string(event.utime);
    addCells(*message->type, Json::parse(message->json), row);
    fileOf(event.channel, *message->type).write(row + "\n");
  }
  void close() {
    for (auto& [channel, file] : files_) file.commit();
    folder_.commit();
  }

  ExportCounts counts;

 private:
  OutputFile& fileOf(const std::string& channel, const MessageType& type) {
    const auto [entry, first] =
        files_.try_emplace(channel, folder_.path() + "/" + channel + ".csv");
    if (!first) return entry->second;
    std::string names = "recorded";
    addNames(type, "", names);
    entry->second.write(names + "\n");
    return entry->second;
  }

  OutputFolder folder_;
  std::map<std::string, OutputFile> files_;
};

}  // namespace

ExportCounts exportCsv(const std::vector<std::string>& logs, const Selection& selection,
                       const std::string& folder) {
  CsvExport csv(folder);
  csv.counts.problem =
      SelectedEvents(logs, selection).forEach([&](const LogEvent& event) { csv.take(event); });
  csv.close();
  return std::move(csv.counts);
}

}  // namespace tread::exporting
