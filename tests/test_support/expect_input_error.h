#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "parameters/input_error.h"

namespace rcme {

// Whether `action` throws an InputError whose message holds every fragment.
template <typename Action>
testing::AssertionResult ThrowsInputError(Action action, const std::vector<std::string>& fragments) {
  try {
    action();
  } catch (const InputError& error) {
    const std::string message = error.what();
    for (const std::string& fragment : fragments) {
      if (message.find(fragment) == std::string::npos) {
        return testing::AssertionFailure() << "the message does not say '" << fragment << "': " << message;
      }
    }
    return testing::AssertionSuccess();
  }
  return testing::AssertionFailure() << "no InputError was thrown";
}

}  // namespace rcme
