#pragma once

#include <string>
#include <string_view>

namespace rcme {

// SHA-256 (FIPS 180-4) of the bytes, as 64 hexadecimal digits: what `sha256sum` prints. Nobody knows how to
// make a second text with the hash of a given one, so that whoever keeps the hash can tell whether a text was
// changed.
std::string Sha256(std::string_view bytes);

}  // namespace rcme
