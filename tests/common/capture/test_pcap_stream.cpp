// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <random>

#include "common/capture/pcap_stream.hpp"
#include "tests/common/capture/capture_file.hpp"

using namespace tread;
using namespace tread::testing;

namespace {

constexpr int64_t kTime = 1'700'000'000'123'456;

struct Read {
  std::vector<CapturedPayload> payloads;
  std::map<std::string, int64_t> left_out;
  std::string problem;
};

/// Reads in pieces, as from a network file.
Read readAll(const std::string& file, size_t piece = 77) {
  Read read;
  PcapStream stream;
  for (size_t at = 0; at < file.size(); at += piece) {
    stream.push(std::string_view(file).substr(at, piece));
    while (auto payload = stream.next()) read.payloads.push_back(std::move(*payload));
    for (const auto& [what, times] : stream.takeLeftOut()) read.left_out[what] += times;
  }
  read.problem = stream.problem();
  return read;
}

}  // namespace

TEST_CASE("datagrams come out of each link layer, VLAN, format and byte order as they went in") {
  for (const uint32_t link_type : {1U, 113U, 276U, 101U, 0U})
    for (const int tags : {0, 1, 2})
      for (const bool blocks : {false, true})
        for (const bool swapped : {false, true})
          for (const bool nanoseconds : {false, true}) {
            if (tags > 0 && (link_type == 0 || link_type == 101)) continue;
            CAPTURE(link_type, tags, blocks, swapped, nanoseconds);
            CaptureFile file({link_type, tags, blocks, swapped, nanoseconds});
            file.add(kTime, "first");
            file.add(kTime + 1'000'001, "second one");
            const Read read = readAll(file.bytes());
            REQUIRE(read.payloads.size() == 2);
            CHECK(read.payloads[0].bytes == "first");
            CHECK(read.payloads[0].from == "10.0.0.1:2368");
            CHECK(read.payloads[1].bytes == "second one");
            CHECK(std::abs(read.payloads[1].time - kTime - 1'000'001) <= (nanoseconds ? 1 : 0));
            CHECK(read.left_out.empty());
          }
}

TEST_CASE("a link layer that is not known is named with its number") {
  CaptureFile file({147, 0, true});
  file.add(kTime, "bytes");
  const Read read = readAll(file.bytes());
  REQUIRE(read.left_out.size() == 1);
  CHECK(read.left_out.begin()->first.find("captured frames of link layer 147") == 0);
}

TEST_CASE("bytes of TCP come in order, those that were sent again once, and a loss is counted") {
  CaptureForm form;
  form.tcp = true;
  CaptureFile file(form);
  file.addSegment(kTime, "abcdef", 0);
  file.addSegment(kTime, "", 6);
  file.addSegment(kTime, "abcdef", 0);
  file.addSegment(kTime, "efgh", 4);
  file.addSegment(kTime, "xyz", 20);
  const Read read = readAll(file.bytes());
  std::string stream;
  for (const CapturedPayload& payload : read.payloads) stream += payload.bytes;
  CHECK(stream == "abcdefghxyz");
  CHECK(read.left_out.at("bytes of TCP that were sent again") == 8);
  CHECK(read.left_out.at("bytes of TCP that the capture lacks") == 12);
}

TEST_CASE("files that are no captures, and damaged ones, say so in one line") {
  CHECK(readAll("no capture, but a text of some length").problem.find("is no capture") !=
        std::string::npos);
  for (const bool blocks : {false, true}) {
    CaptureFile file({1, 0, blocks});
    const size_t header = file.bytes().size();
    file.add(kTime, "first");
    std::string damaged = file.bytes();
    damaged[header + (blocks ? 4 : 8) + 3] = '\x7F';
    CHECK(readAll(damaged).problem.find("the capture is damaged") == 0);
    CHECK(readAll(file.bytes().substr(0, header + 30)).payloads.empty());  // truncated
  }
}

TEST_CASE("mutated captures give payloads of the file's bytes, or nothing, and never more") {
  std::mt19937 random(5);
  for (int i = 0; i < 3000; ++i) {
    CaptureForm form{i % 2 == 0 ? 276U : 1U, i % 3, i % 5 < 3, i % 7 == 0, i % 11 == 0, i % 4 == 0};
    CaptureFile file(form);
    for (int k = 0; k < 5; ++k) file.add(kTime + k, std::string(random() % 100, 'p'));
    std::string bytes = file.bytes();
    for (auto k = 1 + random() % 8; k > 0; --k)
      bytes[random() % bytes.size()] = static_cast<char>(random());
    const Read read = readAll(bytes, 1 + random() % 200);
    size_t size = 0;
    for (const CapturedPayload& payload : read.payloads) size += payload.bytes.size();
    REQUIRE(size <= bytes.size());
  }
}
