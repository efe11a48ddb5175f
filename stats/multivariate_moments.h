#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <stdexcept>

namespace rcme {

// Covariance (k x k) of a stream of vectors in constant memory, by Welford's recursion.
class MultivariateMoments {
 public:
  explicit MultivariateMoments(int dimension)
      : mean_(Eigen::VectorXd::Zero(dimension)), sum_products_(Eigen::MatrixXd::Zero(dimension, dimension)) {}

  void Add(const Eigen::VectorXd& x) {
    CheckDimension(x.size());
    ++n_;
    const Eigen::VectorXd step = x - mean_;
    mean_ += step / static_cast<double>(n_);
    sum_products_ += step * (x - mean_).transpose();
  }

  // NaN below two vectors.
  Eigen::MatrixXd covariance() const {
    if (n_ < 2) return Eigen::MatrixXd::Constant(mean_.size(), mean_.size(), kNaN);
    return (sum_products_ + sum_products_.transpose()) * (0.5 / static_cast<double>(n_ - 1));
  }

 private:
  static constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  void CheckDimension(Eigen::Index size) const {
    if (size != mean_.size()) throw std::invalid_argument("moments: vector of another dimension");
  }

  std::int64_t n_ = 0;
  Eigen::VectorXd mean_;
  Eigen::MatrixXd sum_products_;
};

}  // namespace rcme
