// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/rules/scale_bank.hpp"

#include <algorithm>
#include <cmath>

namespace tread::learner {
namespace {

/// Start of row i of a lower triangle stored by rows.
size_t row(Eigen::Index i) {
  return static_cast<size_t>(i * (i + 1) / 2);
}

}  // namespace

template <int kAxes, int kKinds>
ScaleBank<kAxes, kKinds>::ScaleBank(const Scales& scales)
    : scales_(scales), weights_(static_cast<Eigen::Index>(scales.size())) {
  for (size_t s = 0; s < scales_.size(); ++s)
    weights_[static_cast<Eigen::Index>(s)] = scales_[s].weight;
}

template <int kAxes, int kKinds>
void ScaleBank<kAxes, kKinds>::regress(const Grams& grams, const Eigen::VectorXd& y,
                                       const Eigen::VectorXd& noise) {
  measured_ = y.size();
  const auto n = static_cast<size_t>(measured_);
  constexpr auto kEach = static_cast<size_t>(kLanes);
  chunks_.resize((scales_.size() + kEach - 1) / kEach);
  Eigen::ArrayXd evidence(static_cast<Eigen::Index>(chunks_.size() * kEach));
  for (size_t c = 0; c < chunks_.size(); ++c) {
    Chunk& chunk = chunks_[c];
    chunk.factor.resize(row(measured_));
    chunk.alpha.resize(n);
    for (size_t lane = 0; lane < kEach; ++lane) {
      // Unused lanes repeat the last scale.
      const Scale& scale = scales_[std::min(c * kEach + lane, scales_.size() - 1)];
      const auto at = static_cast<Eigen::Index>(lane);
      for (size_t b = 0; b < kKinds; ++b) chunk.variance[b][at] = scale.variance[b];
      chunk.noise[at] = scale.noise;
    }
    decompose(chunk, grams, noise);
    evidence.segment<kLanes>(static_cast<Eigen::Index>(c) * kLanes) = solve(chunk, y);
  }
  for (size_t s = 0; s < scales_.size(); ++s)
    evidence[static_cast<Eigen::Index>(s)] += std::log(scales_[s].weight);
  weights_ = evidence.head(weights_.size());
  weights_ = (weights_ - weights_.maxCoeff()).exp().eval();
  weights_ /= weights_.sum();
  for (size_t b = 0; b < kKinds; ++b) mean_alpha_[b].setZero(measured_);
  for (size_t c = 0; c < chunks_.size(); ++c) {
    Lanes weight = Lanes::Zero();
    const Eigen::Index begin = static_cast<Eigen::Index>(c) * kLanes;
    const Eigen::Index used = std::min(kLanes, weights_.size() - begin);
    weight.head(used) = weights_.segment(begin, used);
    for (size_t b = 0; b < kKinds; ++b) {
      const Lanes share = weight * chunks_[c].variance[b];
      for (size_t i = 0; i < n; ++i)
        mean_alpha_[b][static_cast<Eigen::Index>(i)] += (share * chunks_[c].alpha[i]).sum();
    }
  }
}

template <int kAxes, int kKinds>
void ScaleBank<kAxes, kKinds>::decompose(Chunk& chunk, const Grams& grams,
                                         const Eigen::VectorXd& noise) const {
  for (Eigen::Index i = 0; i < measured_; ++i) {
    Lanes* const of_i = &chunk.factor[row(i)];
    for (Eigen::Index j = 0; j <= i; ++j) {
      const Lanes* const of_j = &chunk.factor[row(j)];
      Lanes sum = chunk.variance[0] * grams[0](i, j);
      for (size_t b = 1; b < kKinds; ++b) sum += chunk.variance[b] * grams[b](i, j);
      if (i == j) sum += chunk.noise * noise[i];
      for (Eigen::Index k = 0; k < j; ++k) sum -= of_i[k] * of_j[k];
      of_i[j] = i == j ? Lanes(sum.sqrt().inverse()) : Lanes(sum * of_j[j]);
    }
  }
}

template <int kAxes, int kKinds>
auto ScaleBank<kAxes, kKinds>::solve(Chunk& chunk, const Eigen::VectorXd& y) const -> Lanes {
  constexpr Eigen::Index kTogether = 8;  // number of factors whose product stays far from overflow
  Lanes log = Lanes::Zero();
  Lanes product = Lanes::Ones();
  for (Eigen::Index i = 0; i < measured_; ++i) {
    const Lanes* const L = &chunk.factor[row(i)];
    Lanes sum = Lanes::Constant(y[i]);
    for (Eigen::Index k = 0; k < i; ++k) sum -= L[k] * chunk.alpha[static_cast<size_t>(k)];
    sum *= L[i];
    chunk.alpha[static_cast<size_t>(i)] = sum;
    log -= 0.5 * sum.square();
    product *= L[i];
    if ((i + 1) % kTogether != 0 && i + 1 != measured_) continue;
    log += product.log();
    product.setOnes();
  }
  for (Eigen::Index i = measured_ - 1; i >= 0; --i) {
    const Lanes* const L = &chunk.factor[row(i)];
    Lanes& solved = chunk.alpha[static_cast<size_t>(i)];
    solved *= L[i];
    for (Eigen::Index k = 0; k < i; ++k) chunk.alpha[static_cast<size_t>(k)] -= L[k] * solved;
  }
  return log;
}

template <int kAxes, int kKinds>
bool ScaleBank<kAxes, kKinds>::counts(size_t chunk, double least) const {
  const Eigen::Index begin = static_cast<Eigen::Index>(chunk) * kLanes;
  return !(weights_.segment(begin, std::min(kLanes, weights_.size() - begin)).maxCoeff() < least);
}

template <int kAxes, int kKinds>
auto ScaleBank<kAxes, kKinds>::predict(const Cross& cross, const Blocks& own, double least) const
    -> std::vector<Predicted> {
  std::vector<Predicted> predicted;
  predicted.reserve(scales_.size());
  for (size_t s = 0; s < scales_.size(); ++s) {
    if (weight(s) < least) continue;
    Block covariance = scales_[s].variance[0] * own[0];
    for (size_t b = 1; b < kKinds; ++b) covariance += scales_[s].variance[b] * own[b];
    predicted.push_back({weight(s), Vector::Zero(), covariance, scales_[s].noise});
  }
  if (measured_ == 0) return predicted;
  std::vector<std::array<Lanes, kAxes>> k(static_cast<size_t>(measured_));
  auto next = predicted.begin();
  for (size_t c = 0; c < chunks_.size(); ++c) {
    if (!counts(c, least)) continue;
    const Chunk& chunk = chunks_[c];
    std::array<Lanes, kAxes> mean;
    std::array<Lanes, kAxes * kAxes> known;
    mean.fill(Lanes::Zero());
    known.fill(Lanes::Zero());
    for (Eigen::Index i = 0; i < measured_; ++i) {
      const Lanes* const L = &chunk.factor[row(i)];
      auto& k_i = k[static_cast<size_t>(i)];
      for (int a = 0; a < kAxes; ++a) {
        Lanes sum = chunk.variance[0] * cross[0](i, a);
        for (size_t b = 1; b < kKinds; ++b) sum += chunk.variance[b] * cross[b](i, a);
        mean[a] += sum * chunk.alpha[static_cast<size_t>(i)];
        for (Eigen::Index j = 0; j < i; ++j) sum -= L[j] * k[static_cast<size_t>(j)][a];
        k_i[a] = sum * L[i];
      }
      for (int a = 0; a < kAxes; ++a)
        for (int b = 0; b < kAxes; ++b) known[kAxes * a + b] += k_i[a] * k_i[b];
    }
    for (Eigen::Index lane = 0; lane < kLanes; ++lane) {
      const size_t s = c * static_cast<size_t>(kLanes) + static_cast<size_t>(lane);
      if (s >= scales_.size() || weight(s) < least) continue;
      for (int a = 0; a < kAxes; ++a) {
        next->mean[a] = mean[a][lane];
        for (int b = 0; b < kAxes; ++b) next->covariance(a, b) -= known[kAxes * a + b][lane];
      }
      ++next;
    }
  }
  return predicted;
}

template <int kAxes, int kKinds>
Eigen::VectorXd ScaleBank<kAxes, kKinds>::doubt(const Eigen::VectorXd& noise, double least) const {
  Eigen::VectorXd doubt = Eigen::VectorXd::Zero(measured_);
  const double total = (weights_ < least).select(0.0, weights_).sum();
  std::vector<Lanes> inverse(static_cast<size_t>(measured_));  // a column of L^-1
  for (size_t c = 0; c < chunks_.size(); ++c) {
    if (!counts(c, least)) continue;
    const Chunk& chunk = chunks_[c];
    const Eigen::Index begin = static_cast<Eigen::Index>(c) * kLanes;
    Lanes weight = Lanes::Zero();
    for (Eigen::Index lane = 0; lane < std::min(kLanes, weights_.size() - begin); ++lane)
      if (weights_[begin + lane] >= least) weight[lane] = weights_[begin + lane] / total;
    for (Eigen::Index column = 0; column < measured_; ++column) {
      Lanes squares = Lanes::Zero();
      for (Eigen::Index i = column; i < measured_; ++i) {
        const Lanes* const L = &chunk.factor[row(i)];
        Lanes sum = Lanes::Constant(i == column ? 1.0 : 0.0);
        for (Eigen::Index k = column; k < i; ++k) sum -= L[k] * inverse[static_cast<size_t>(k)];
        sum *= L[i];
        inverse[static_cast<size_t>(i)] = sum;
        squares += sum.square();
      }
      const Lanes N = chunk.noise * noise[column];
      doubt[column] += (weight * (N - N.square() * squares).max(0.0)).sum();
    }
  }
  return doubt;
}

template class ScaleBank<2, 5>;
template class ScaleBank<1, 5>;

}  // namespace tread::learner
