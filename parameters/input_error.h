#pragma once

#include <stdexcept>

namespace rcme {

// The user's input is wrong: a file, a key, a value, a path. The message names it and says what is allowed.
// The program answers with exit code 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace rcme
