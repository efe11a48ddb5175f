#pragma once

#include <string>
#include <string_view>

namespace rcme {

// Computes SHA-256 (FIPS 180-4) of the bytes as 64 hexadecimal digits, as `sha256sum` prints it. No method
// is known to make a second text with a given hash, so a kept hash shows whether a text was changed.
std::string Sha256(std::string_view bytes);

}  // namespace rcme
