// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/store/entry_name.hpp"
#include "common/store/store.hpp"

namespace tread {

std::optional<std::string> MemoryStore::read(const std::string& name) const {
  const auto found = entries_.find(name);
  if (found == entries_.end()) return std::nullopt;
  return found->second;
}

std::optional<std::string> MemoryStore::write(const std::string& name, const std::string& content) {
  if (!isEntryName(name)) return badEntryName();
  if (!problem_.empty()) return problem_;
  entries_[name] = content;
  return std::nullopt;
}

void MemoryStore::remove(const std::string& name) {
  entries_.erase(name);
}

std::vector<std::string> MemoryStore::names() const {
  std::vector<std::string> all;
  for (const auto& entry : entries_) all.push_back(entry.first);
  return all;
}

}  // namespace tread
