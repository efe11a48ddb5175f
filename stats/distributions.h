// Quantiles and distribution functions of the reference laws, by Boost.Math.
#pragma once

namespace rcme {

double ChiSquareQuantile(int degrees_of_freedom, double probability);
double ChiSquareCdf(int degrees_of_freedom, double x);
double NormalQuantile(double probability);
double NormalCdf(double x);
double StudentQuantile(int degrees_of_freedom, double probability);

}  // namespace rcme
