#pragma once

#include <functional>
#include <vector>

namespace rcme {

// Kolmogorov-Smirnov test of a sample against a fully known continuous law.
struct KolmogorovSmirnov {
  double statistic = 0.0;  // sup |F_n - F|
  double p_value = 1.0;    // asymptotic law with Stephens' correction; good for n >= 20
};
KolmogorovSmirnov TestKolmogorovSmirnov(std::vector<double> sample, const std::function<double(double)>& cdf);

}  // namespace rcme
