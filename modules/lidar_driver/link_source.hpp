// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "common/link/link.hpp"
#include "modules/lidar_driver/core/scan_device.hpp"

namespace tread::lidar {

/// A device's bytes over a link: opens it, opens it anew where the device is lost.
class LinkSource : public ScanSource {
 public:
  using MakeLink = std::function<std::unique_ptr<Link>()>;

  LinkSource(MakeLink make_link, std::unique_ptr<ScanDevice> device)
      : make_link_(std::move(make_link)), device_(std::move(device)), link_(make_link_()) {}

  std::vector<RangeScan> take(int64_t utime) override;
  Reason reason(int64_t utime, bool ground) const override;
  std::string shortcomings() const override { return device_->shortcomings(); }
  std::map<std::string, int64_t> counters() const override;
  const Link& link() const { return *link_; }

 private:
  std::string linkProblem() const;
  bool keepOpen(int64_t utime);
  void read(int64_t utime);

  MakeLink make_link_;
  std::unique_ptr<ScanDevice> device_;
  std::unique_ptr<Link> link_;
  bool was_open_ = false;
  int64_t last_open_ = 0;
  int64_t connections_ = 0;
};

}  // namespace tread::lidar
