#pragma once

#include <stdexcept>

#include "parameters/input_error.h"

namespace rcme {

// A result file has content that no run can have written. The message says what and where, without the path.
class Damage : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The same error for the user: it adds the path and the command that shows what can be recovered.
class DamagedFileError : public InputError {
 public:
  using InputError::InputError;
};

}  // namespace rcme
