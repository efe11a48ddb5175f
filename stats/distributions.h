// Quantiles and distribution functions of the reference laws, by Boost.Math.
#pragma once

#include <cstdint>

namespace rcme {

double ChiSquareQuantile(int degrees_of_freedom, double probability);
double ChiSquareCdf(int degrees_of_freedom, double x);
// The law of the squared length of a normal vector whose mean has squared length `noncentrality`.
double NonCentralChiSquareCdf(int degrees_of_freedom, double noncentrality, double x);
double NormalQuantile(double probability);
double NormalCdf(double x);
double StudentQuantile(double degrees_of_freedom, double probability);
// P(Binomial(n, probability) <= successes); 0 for negative counts, 1 from n on.
double BinomialCdf(std::int64_t successes, std::int64_t n, double probability);
// The law of the ratio of two independent chi-squares, each divided by its degrees of freedom.
double FisherCdf(int degrees_of_freedom_1, int degrees_of_freedom_2, double x);
// P(Binomial(n, p) >= k).
double BinomialUpperTail(int n, int k, double p);

}  // namespace rcme
