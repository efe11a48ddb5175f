#pragma once

#include <stdexcept>

#include "parameters/input_error.h"

namespace rcme {

// Something in a result file that no run can have written. The message says what and where, without the path.
class Damage : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The same as the user hears of it: with the path, and with the command that says what can be saved.
class DamagedFileError : public InputError {
 public:
  using InputError::InputError;
};

}  // namespace rcme
