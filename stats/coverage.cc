#include "stats/coverage.h"

#include <stdexcept>

#include "stats/distributions.h"

namespace rcme {

Coverage::Coverage(int degrees_of_freedom) : degrees_of_freedom_(degrees_of_freedom) {
  for (size_t i = 0; i < quantiles_.size(); ++i) {
    quantiles_[i] = ChiSquareQuantile(degrees_of_freedom, 1.0 - kSignificanceLevels[i]);
  }
}

void Coverage::Add(double statistic) {
  ++n_;
  for (size_t i = 0; i < quantiles_.size(); ++i) {
    if (statistic >= 0.0 && statistic <= quantiles_[i]) ++num_covered_[i];
  }
}

void Coverage::Merge(const Coverage& other) {
  if (other.degrees_of_freedom_ != degrees_of_freedom_) {
    throw std::invalid_argument("coverage: cannot merge counts of different degrees of freedom");
  }
  n_ += other.n_;
  for (size_t i = 0; i < num_covered_.size(); ++i) num_covered_[i] += other.num_covered_[i];
}

std::array<Coverage::Level, Coverage::kSignificanceLevels.size()> Coverage::Levels(double confidence) const {
  std::array<Level, kSignificanceLevels.size()> levels;
  for (size_t i = 0; i < levels.size(); ++i) {
    levels[i] = {.nominal = 1.0 - kSignificanceLevels[i],
                 .num_covered = num_covered_[i],
                 .n = n_,
                 .measured = static_cast<double>(num_covered_[i]) / static_cast<double>(n_),
                 .interval = ExactBinomialInterval(num_covered_[i], n_, confidence)};
  }
  return levels;
}

}  // namespace rcme
