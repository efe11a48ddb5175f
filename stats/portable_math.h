// Elementary functions from IEEE additions, multiplications, divisions and square roots alone, so that a
// random stream is bit-identical with every C library and processor. (The C library's log and cos differ in
// the last bit between versions, and between machines with and without fused multiply-add.) Error below 2e-15
// relative for Log and Exp, 5e-16 absolute for cosine and sine.
#pragma once

namespace rcme {

// Natural logarithm of a finite x > 0 (normal numbers).
double PortableLog(double x);

// e^x for x <= 700; 0 below -700, where e^x is less than 1e-304.
double PortableExp(double x);

// cos(2 pi u) and sin(2 pi u) for u in [0, 1).
struct CosSin {
  double cos, sin;
};
CosSin PortableCosSinOfTurn(double u);

}  // namespace rcme
