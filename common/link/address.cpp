// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/link/address.hpp"

#include <charconv>
#include <stdexcept>

#include "common/link/baud_rates.hpp"

namespace tread {
namespace {

[[noreturn]] void refuse(const std::string& text, const std::string& problem) {
  throw std::invalid_argument("link address \"" + text + "\": " + problem);
}

/// A plain decimal number from 1 to `max`; 0 for anything else.
int positive(const std::string& digits, int max) {
  int value = 0;
  const char* end = digits.data() + digits.size();
  const auto result = std::from_chars(digits.data(), end, value);
  const bool good = result.ec == std::errc() && result.ptr == end && value >= 1 && value <= max;
  return good ? value : 0;
}

uint16_t portOf(const LinkAddress& address, const std::string& digits) {
  const int port = positive(digits, 65535);
  if (port == 0) refuse(address.text, "the port is \"" + digits + "\"; allowed 1..65535");
  return static_cast<uint16_t>(port);
}

void parseTty(LinkAddress& address, const std::string& rest) {
  const size_t question = rest.find('?');
  address.path = rest.substr(0, question);
  if (address.path.empty())
    refuse(address.text, "the device is missing; write tty:/dev/ttyUSB0?baud=115200");
  if (question == std::string::npos) return;
  const std::string option = rest.substr(question + 1);
  const std::string key = "baud=";
  if (option.compare(0, key.size(), key) != 0)
    refuse(address.text, "unknown option \"" + option + "\"; allowed baud=");
  address.baud = positive(option.substr(key.size()), 4'000'000);
  if (!speedOf(address.baud))
    refuse(address.text,
           "\"" + option + "\" is no rate of a serial line; for instance baud=115200");
}

void parseTcp(LinkAddress& address, const std::string& rest) {
  const size_t colon = rest.rfind(':');
  if (colon == std::string::npos || colon == 0)
    refuse(address.text, "host or port is missing; write tcp:host:port");
  address.host = rest.substr(0, colon);
  if (address.host.size() > 2 && address.host.front() == '[' && address.host.back() == ']')
    address.host = address.host.substr(1, address.host.size() - 2);
  address.port = portOf(address, rest.substr(colon + 1));
}

/// A port, or a number to listen on and a port.
void parseListener(LinkAddress& address, const std::string& rest) {
  const size_t colon = rest.rfind(':');
  if (colon != std::string::npos) address.host = rest.substr(0, colon);
  address.port = portOf(address, colon == std::string::npos ? rest : rest.substr(colon + 1));
}

}  // namespace

LinkAddress parseLinkAddress(const std::string& text) {
  LinkAddress address;
  address.text = text;
  const size_t colon = text.find(':');
  const std::string kind = text.substr(0, colon);
  const std::string rest = colon == std::string::npos ? "" : text.substr(colon + 1);
  if (kind == "tty" && colon != std::string::npos) {
    address.kind = LinkAddress::Kind::kTty;
    parseTty(address, rest);
  } else if (kind == "tcp" && colon != std::string::npos) {
    address.kind = LinkAddress::Kind::kTcp;
    parseTcp(address, rest);
  } else if (kind == "tcp-server" && colon != std::string::npos) {
    address.kind = LinkAddress::Kind::kTcpServer;
    parseListener(address, rest);
  } else if (kind == "udp" && colon != std::string::npos) {
    address.kind = LinkAddress::Kind::kUdp;
    parseListener(address, rest);
  } else if (kind == "pty" && colon != std::string::npos) {
    address.kind = LinkAddress::Kind::kPty;
    address.path = rest;
    if (rest.empty()) refuse(text, "the name is missing; write pty:path of a link to make");
  } else if (kind == "file" && colon != std::string::npos) {
    address.kind = LinkAddress::Kind::kFile;
    address.path = rest;
    if (rest.empty()) refuse(text, "the path is missing; write file:path");
  } else {
    refuse(text,
           "unknown kind; allowed tty:/dev/ttyUSB0?baud=115200, tcp:host:port, udp:port, "
           "file:path, and for emulators pty:path, tcp-server:port");
  }
  return address;
}

}  // namespace tread
