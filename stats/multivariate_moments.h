#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <stdexcept>

namespace rcme {

// Mean (k) and covariance (k x k) of a stream of vectors in constant memory: Welford's recursion and Chan's
// merge, as in Moments.
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

  void Merge(const MultivariateMoments& other) {
    CheckDimension(other.mean_.size());
    if (other.n_ == 0) return;
    const double n = static_cast<double>(n_), m = static_cast<double>(other.n_);
    const Eigen::VectorXd step = other.mean_ - mean_;
    n_ += other.n_;
    mean_ += step * (m / (n + m));
    sum_products_ += other.sum_products_ + step * step.transpose() * (n * m / (n + m));
  }

  std::int64_t n() const { return n_; }
  // NaN if there are not enough vectors.
  Eigen::VectorXd mean() const { return n_ > 0 ? mean_ : Eigen::VectorXd::Constant(mean_.size(), kNaN); }
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
