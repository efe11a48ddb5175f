// Small inputs that take much: how they are made, and that they are refused without taking it.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/peak_memory.h"

namespace rcme {

inline std::string Repeated(const std::string& text, size_t times) {
  std::string repeated;
  repeated.reserve(text.size() * times);
  for (size_t i = 0; i < times; ++i) repeated += text;
  return repeated;
}

// Whether `action` throws an InputError that holds every fragment, on one line, and takes less than `max_mb`.
template <typename Action>
testing::AssertionResult IsRefusedWithin(double max_mb, Action action,
                                         const std::vector<std::string>& fragments) {
  testing::AssertionResult refused = testing::AssertionFailure();
  const double peak_mb = PeakMemoryMb([&] { refused = ThrowsInputError(action, fragments); });
  if (refused && CanMeasurePeakMemory() && peak_mb > max_mb)
    return testing::AssertionFailure() << "it took " << peak_mb << " MB; " << max_mb << " are allowed";
  return refused;
}

}  // namespace rcme
