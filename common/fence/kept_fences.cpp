// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/fence/kept_fences.hpp"

#include <algorithm>
#include <utility>

#include <zlib.h>

namespace tread {
namespace {

// In the store.
constexpr const char* kHolders = "fences_of_holders";
constexpr const char* kOthers = "fences_of_others";
constexpr const char* kMarker = "fences_are_kept";

/// First line of an entry. Entries of older versions have none.
std::string headOf(const std::string& lines) {
  const auto* bytes = reinterpret_cast<const Bytef*>(lines.data());
  return "checked " + std::to_string(lines.size()) + " " +
         std::to_string(crc32_z(0, bytes, lines.size())) + "\n";
}

struct Entry {
  bool there = false;
  bool checked = false;  ///< its first line is right
  bool readable = true;
  std::vector<Fence> fences;
};

Entry entryOf(const Store& store, const std::vector<std::string>& names, const char* name) {
  Entry entry;
  entry.there = std::find(names.begin(), names.end(), name) != names.end();
  const std::optional<std::string> text = store.read(name);
  const size_t end = text ? text->find('\n') : std::string::npos;
  const size_t head = end == std::string::npos ? 0 : end + 1;
  entry.checked = head > 0 && text->substr(0, head) == headOf(text->substr(head));
  int broken = 0;
  entry.fences = fencesFrom(text.value_or("").substr(entry.checked ? head : 0), broken);
  entry.readable = broken == 0 && text.has_value() == entry.there;
  return entry;
}

}  // namespace

KeptFences readFences(const Store& store) {
  const std::vector<std::string> names = store.names();
  Entry entries[] = {entryOf(store, names, kHolders), entryOf(store, names, kOthers)};
  const bool marked = std::find(names.begin(), names.end(), kMarker) != names.end() ||
                      entries[0].checked || entries[1].checked;
  KeptFences kept;
  for (Entry& entry : entries) {
    const bool good = entry.readable && (entry.checked || !marked);
    kept.lost |= !good;
    if (!good) entry.fences.clear();
  }
  kept.holders = std::move(entries[0].fences);
  kept.others = std::move(entries[1].fences);
  return kept;
}

std::optional<std::string> writeFences(Store& store, const KeptFences& fences) {
  const std::string holders = toText(fences.holders), others = toText(fences.others);
  // The marker last: entries that were never written do not count as lost.
  for (const auto& [name, text] :
       {std::pair(kOthers, headOf(others) + others), std::pair(kHolders, headOf(holders) + holders),
        std::pair(kMarker, std::string("both are here\n"))})
    if (auto problem = store.write(name, text)) return problem;
  return std::nullopt;
}

}  // namespace tread
