#pragma once

#include <cstdint>
#include <string>

#include "parameters/input_error.h"

namespace rcme {

inline std::string AsText(const std::uint8_t* data, size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

// Any exception but InputError goes through: libFuzzer calls it a crash. 0, as LLVMFuzzerTestOneInput has to
// return.
template <typename Action>
int OnlyInputError(Action action) {
  try {
    action();
  } catch (const InputError&) {
  }
  return 0;
}

}  // namespace rcme
