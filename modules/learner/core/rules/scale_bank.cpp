// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/rules/scale_bank.hpp"

#include <cmath>

#include <Eigen/Cholesky>

namespace tread::learner {

template <int kAxes, int kKinds>
void ScaleBank<kAxes, kKinds>::regress(const Grams& grams, const Eigen::VectorXd& y,
                                       const Eigen::VectorXd& noise) {
  const Eigen::Index n = y.size();
  each_.resize(scales_.size());
  Eigen::ArrayXd evidence(static_cast<Eigen::Index>(scales_.size()));
  for (size_t s = 0; s < scales_.size(); ++s) {
    One& one = each_[s];
    one.factor = Eigen::VectorXd(scales_[s].noise * noise).asDiagonal();
    for (size_t b = 0; b < kKinds; ++b) one.factor += scales_[s].variance[b] * grams[b];
    Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> decomposed(one.factor);
    one.alpha = decomposed.solve(y);
    double& log = evidence[static_cast<Eigen::Index>(s)];
    log = std::log(scales_[s].weight) - 0.5 * y.dot(one.alpha);
    for (Eigen::Index i = 0; i < n; ++i) log -= std::log(one.factor(i, i));
  }
  const Eigen::ArrayXd weights = (evidence - evidence.maxCoeff()).exp();
  const double total = weights.sum();
  for (size_t b = 0; b < kKinds; ++b) mean_alpha_[b].setZero(n);
  for (size_t s = 0; s < scales_.size(); ++s) {
    each_[s].weight = weights[static_cast<Eigen::Index>(s)] / total;
    for (size_t b = 0; b < kKinds; ++b)
      mean_alpha_[b] += each_[s].weight * scales_[s].variance[b] * each_[s].alpha;
  }
}

template <int kAxes, int kKinds>
auto ScaleBank<kAxes, kKinds>::predict(const Cross& cross, const Blocks& own, double least) const
    -> std::vector<Predicted> {
  std::vector<Predicted> predicted;
  Eigen::Matrix<double, Eigen::Dynamic, kAxes> k;
  for (size_t s = 0; s < scales_.size(); ++s) {
    const double weight = each_.empty() ? scales_[s].weight : each_[s].weight;
    if (weight < least) continue;
    Block covariance = scales_[s].variance[0] * own[0];
    for (size_t b = 1; b < kKinds; ++b) covariance += scales_[s].variance[b] * own[b];
    Vector mean = Vector::Zero();
    if (!each_.empty() && each_[s].alpha.size() > 0) {
      k = scales_[s].variance[0] * cross[0];
      for (size_t b = 1; b < kKinds; ++b) k += scales_[s].variance[b] * cross[b];
      mean = k.transpose() * each_[s].alpha;
      each_[s].factor.template triangularView<Eigen::Lower>().solveInPlace(k);
      covariance -= k.transpose() * k;
    }
    predicted.push_back({weight, mean, covariance, scales_[s].noise});
  }
  return predicted;
}

template <int kAxes, int kKinds>
Eigen::VectorXd ScaleBank<kAxes, kKinds>::doubt(const Eigen::VectorXd& noise, double least) const {
  Eigen::VectorXd doubt = Eigen::VectorXd::Zero(noise.size());
  double total = 0.0;
  for (size_t s = 0; s < each_.size(); ++s) {
    const One& one = each_[s];
    if (one.weight < least) continue;
    const Eigen::ArrayXd N = scales_[s].noise * noise.array();
    const Eigen::MatrixXd inverse = one.factor.template triangularView<Eigen::Lower>().solve(
        Eigen::MatrixXd::Identity(noise.size(), noise.size()));
    doubt +=
        one.weight *
        (N - N.square() * inverse.colwise().squaredNorm().transpose().array()).max(0.0).matrix();
    total += one.weight;
  }
  return doubt / total;
}

template class ScaleBank<2, 2>;
template class ScaleBank<1, 3>;

}  // namespace tread::learner
