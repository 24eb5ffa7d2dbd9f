// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/models/twist_pieces.hpp"

#include <cmath>

namespace tread::gap {
namespace {

constexpr double kLongAgo = 30.0;  // [s] since a change before the segment

/// The acting command over time, and the previous one.
class ActingCommand {
 public:
  ActingCommand(const Segment& segment, const VehicleModel& vehicle)
      : commands_(segment.commands),
        vehicle_(vehicle),
        asked_(segment.command_before.tracks()),
        before_(segment.command_before.tracks()),
        began_(segment.begin() - kLongAgo) {}

  DrivenPiece at(double time) {
    for (; next_ < commands_.size() && commands_[next_].time + vehicle_.commandDelay() <= time;
         ++next_) {
      const TrackCommand command = commands_[next_].command.tracks();
      if (command == asked_) continue;
      before_ = asked_;
      asked_ = command;
      began_ = commands_[next_].time + vehicle_.commandDelay();
    }
    const TrackCommand now = vehicle_.trackSpeeds(asked_);
    const TrackCommand old = vehicle_.trackSpeeds(before_);
    DrivenPiece piece;
    piece.asked_v = (now.left + now.right) / 2.0;
    piece.asked_turn = (now.right - now.left) / 2.0;
    piece.old_v = (old.left + old.right) / 2.0;
    piece.old_turn = (old.right - old.left) / 2.0;
    piece.since = time - began_;
    return piece;
  }

 private:
  const std::vector<CommandSample>& commands_;
  const VehicleModel& vehicle_;
  TrackCommand asked_;
  TrackCommand before_;
  double began_;
  size_t next_ = 0;
};

DrivenPiece scaled(DrivenPiece piece, const PieceScale& scale) {
  piece.v /= scale.v;
  piece.omega /= scale.omega;
  piece.asked_v /= scale.v;
  piece.old_v /= scale.v;
  piece.asked_turn /= scale.v;
  piece.old_turn /= scale.v;
  return piece;
}

double twiceRootMean(double squares, double count) {
  return squares > 0.0 ? 2.0 * std::sqrt(squares / count) : 1.0;
}

}  // namespace

TwistPieces::TwistPieces(const Observations& data, const VehicleModel& vehicle) {
  const Motions motions = data.simulate(vehicle);
  for (size_t drive = 0; drive < data.drives().size(); ++drive)
    for (size_t s = 0; s < data.drives()[drive].segments.size(); ++s) {
      const std::vector<MotionSample>& motion = motions[data.segmentIndex(drive, s)];
      ActingCommand acting(data.drives()[drive].segments[s], vehicle);
      counts_.push_back(motion.size() - 1);
      begins_.push_back(motion.front());
      for (size_t i = 1; i < motion.size(); ++i) {
        SimulatedPiece piece;
        piece.duration = motion[i].time - motion[i - 1].time;
        const double middle = (motion[i].time + motion[i - 1].time) / 2.0;
        piece.v_body =
            twistTo(between(motion[i - 1].T_map_body, motion[i].T_map_body), piece.duration);
        piece.driven = acting.at(middle);
        piece.driven.v = piece.v_body.v_x;
        piece.driven.omega = piece.v_body.omega;
        piece.block = data.blockAt(drive, s, middle);
        pieces_.push_back(piece);
      }
    }
}

Motions TwistPieces::motions(const Eigen::MatrixX3d& correction) const {
  Motions motions;
  motions.reserve(counts_.size());
  size_t at = 0;
  for (size_t s = 0; s < counts_.size(); ++s) {
    std::vector<MotionSample> motion{begins_[s]};
    motion.reserve(counts_[s] + 1);
    for (size_t i = 0; i < counts_[s]; ++i, ++at) {
      const SimulatedPiece& piece = pieces_[at];
      const auto row = static_cast<Eigen::Index>(at);
      const Twist2 v_body{piece.v_body.v_x + correction(row, 0),
                          piece.v_body.v_y + correction(row, 1),
                          piece.v_body.omega + correction(row, 2)};
      motion.push_back({motion.back().time + piece.duration,
                        motion.back().T_map_body * integrate(v_body, piece.duration)});
    }
    motions.push_back(std::move(motion));
  }
  return motions;
}

PieceScale TwistPieces::scaleOf(const std::vector<char>& block_counts) const {
  double v = 0.0;
  double omega = 0.0;
  double count = 0.0;
  for (const SimulatedPiece& piece : pieces_) {
    if (!block_counts[static_cast<size_t>(piece.block)]) continue;
    v += std::pow(piece.driven.v, 2);
    omega += std::pow(piece.driven.omega, 2);
    count += 1.0;
  }
  return {twiceRootMean(v, count), twiceRootMean(omega, count)};
}

Eigen::MatrixXd TwistPieces::valuesOf(const std::vector<TwistTerm>& terms,
                                      const PieceScale& scale) const {
  Eigen::MatrixXd values(static_cast<Eigen::Index>(pieces_.size()),
                         static_cast<Eigen::Index>(terms.size()));
  for (size_t p = 0; p < pieces_.size(); ++p) {
    const DrivenPiece piece = scaled(pieces_[p].driven, scale);
    for (size_t t = 0; t < terms.size(); ++t)
      values(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(t)) = terms[t].value(piece);
  }
  return values;
}

}  // namespace tread::gap
