#pragma once

#include <stdexcept>

namespace rcme {

// Invalid user input: a file, a key, a value, a path. The message names it and says what is allowed. The
// program exits with code 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace rcme
