#pragma once

#include "stats/intervals.h"
#include "stats/moments.h"

namespace rcme {

// The interval of the mean of lognormal numbers from the moments of their logarithms (Cox; Zhou & Gao 1997):
//   exp(m + v / 2 +- t_(n-1) sqrt(v / n + v^2 / (2 (n - 1)))),  m and v mean and variance of the logarithms.
// Student's interval of the numbers themselves covers too little if they scatter widely. For 20 lognormal
// numbers with relative standard deviation 1 it covers 0.89, this one 0.95; for 20 gamma numbers 0.92 and
// 0.98. Unbounded below two numbers.
Interval LognormalMeanInterval(const Moments& logarithms, double confidence = 0.95);

}  // namespace rcme
