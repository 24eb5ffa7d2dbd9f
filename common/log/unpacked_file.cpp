// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/log/unpacked_file.hpp"

#include <zlib.h>

#include <fstream>
#include <stdexcept>
#include <vector>

namespace tread {

std::string packingOf(const std::string& path) {
  static const std::pair<const char*, std::string> kPackings[] = {{"gzip", "\x1f\x8b"},
                                                                  {"xz",
                                                                   "\xfd"
                                                                   "7zXZ"},
                                                                  {"bzip2", "BZh"},
                                                                  {"zstd", "\x28\xb5\x2f\xfd"},
                                                                  {"zip", "PK\x03\x04"}};
  std::ifstream file(path, std::ios::binary);
  std::string begin(6, '\0');
  file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  begin.resize(static_cast<size_t>(file.gcount()));
  for (const auto& [packing, magic] : kPackings)
    if (begin.rfind(magic, 0) == 0) return packing;
  return "";
}

UnpackedFile::UnpackedFile(const std::string& name) : name_(name), path_(name) {
  const std::string packing = packingOf(name);
  if (packing == "gzip") unpack();
  if (packing == "gzip" || packing.empty()) return;
  const std::string command = packing == "zip" ? "unzip" : packing + " -dk";
  throw std::runtime_error(name + ": is packed by " + packing + "; unpack it first: " + command +
                           " " + name);
}

void UnpackedFile::unpack() {
  file_.reset(std::tmpfile());
  gzFile packed = gzopen(name_.c_str(), "rb");
  if (!file_ || packed == nullptr) {
    if (packed != nullptr) gzclose(packed);
    throw std::runtime_error(name_ + ": cannot be unpacked; is there room for temporary files?");
  }
  std::vector<char> buffer(1 << 18);
  int count = 0;
  bool written = true;
  while (written &&
         (count = gzread(packed, buffer.data(), static_cast<unsigned>(buffer.size()))) > 0)
    written = std::fwrite(buffer.data(), 1, static_cast<size_t>(count), file_.get()) ==
              static_cast<size_t>(count);
  // At the end of the data from gzread, only the state reveals a truncated file.
  int error = Z_OK;
  gzerror(packed, &error);
  if (error != Z_OK) problem_ = name_ + ": the gzip data is damaged or cut off";
  gzclose(packed);
  if (!written || std::fflush(file_.get()) != 0)
    throw std::runtime_error(name_ + ": cannot be unpacked; is there room for temporary files?");
  path_ = "/proc/self/fd/" + std::to_string(fileno(file_.get()));
}

std::string UnpackedFile::named(std::string message) const {
  if (path_ == name_) return message;
  for (size_t at = 0; (at = message.find(path_, at)) != std::string::npos; at += name_.size())
    message.replace(at, path_.size(), name_);
  return message;
}

std::string UnpackedFile::reasonOf(const std::string& failure) const {
  if (problem_.empty()) return named(failure);
  return problem_ + "; get a complete copy of it (unpacked as far as possible: " + named(failure) +
         ")";
}

}  // namespace tread
