#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

namespace rcme {

// As LLVMFuzzerTestOneInput.
using Harness = int (*)(const std::uint8_t* data, size_t size);

const std::map<std::string, Harness>& Harnesses();

}  // namespace rcme
