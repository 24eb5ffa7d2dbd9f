// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/bus/lcm_address.hpp"

#include <algorithm>
#include <cstdlib>
#include <regex>
#include <sstream>

namespace tread {

std::optional<LcmAddress> parseLcmUrl(const std::string& url) {
  static const std::regex kUrl(R"re(([^:]+)://([^:?]*)(?::(\d{1,5}))?(?:\?(.*))?)re");
  static const std::regex kOption(R"re((ttl|recv_buf_size)=(\d{1,12}))re");
  std::smatch part;
  if (!std::regex_match(url, part, kUrl)) return std::nullopt;
  LcmAddress address;
  address.provider = part[1];
  if (address.provider == "tcpq") {
    address.group = "127.0.0.1";
    address.port = 7700;
  }
  if (part[2].length() > 0) address.group = part[2];
  if (part[3].matched) {
    const int port = std::stoi(part[3]);
    if (port < 1 || port > 65535) return std::nullopt;
    address.port = static_cast<uint16_t>(port);
  }
  std::istringstream options(part[4]);
  for (std::string option; std::getline(options, option, '&');) {
    std::smatch found;
    const std::string key = option.substr(0, option.find('='));
    if (key != "ttl" && key != "recv_buf_size") continue;
    if (!std::regex_match(option, found, kOption)) return std::nullopt;
    if (key == "ttl")
      address.ttl = static_cast<int>(std::min<int64_t>(std::stoll(found[2]), 255));
    else
      address.receive_buffer = std::stoll(found[2]);
  }
  return address;
}

std::string effectiveLcmUrl(const std::string& url) {
  if (!url.empty()) return url;
  const char* const named = std::getenv("LCM_DEFAULT_URL");
  return named != nullptr && *named != '\0' ? named : "udpm://239.255.76.67:7667?ttl=0";
}

}  // namespace tread
