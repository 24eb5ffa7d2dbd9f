// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <stdexcept>

#include "common/link/kinds.hpp"

namespace tread {

std::unique_ptr<Link> makeLink(const std::string& address) {
  const LinkAddress parsed = parseLinkAddress(address);
  switch (parsed.kind) {
    case LinkAddress::Kind::kTty:
      return makeTtyLink(parsed);
    case LinkAddress::Kind::kPty:
      return makePtyLink(parsed);
    case LinkAddress::Kind::kTcpServer:
      return makeTcpServerLink(parsed);
    case LinkAddress::Kind::kTcp:
      return makeTcpLink(parsed);
    case LinkAddress::Kind::kUdp:
      return makeUdpLink(parsed);
    case LinkAddress::Kind::kFile:
      return makeFileLink(parsed);
  }
  throw std::invalid_argument("link address \"" + address + "\": unknown kind");
}

}  // namespace tread
