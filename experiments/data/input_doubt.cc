#include "experiments/data/input_doubt.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/core/text/message.h"
#include "parameters/plain_text.h"

namespace rcme {

void InputWarnings::Add(const std::vector<InputDoubt>& doubts) {
  for (const InputDoubt& doubt : doubts) {
    const auto known = std::ranges::find_if(
        warnings_, [&](const Warning& warning) { return warning.first.what == doubt.what; });
    if (known == warnings_.end()) {
      warnings_.push_back({doubt, 1});
    } else {
      ++known->count;
    }
  }
}

void InputWarnings::Print() const {
  for (const auto& [first, count] : warnings_) {
    const std::string more = count > 1 ? fmt::format(" (and {} more)", count - 1) : "";
    PrintMessage("warning: {}{}: {}\n", Printable(first.place), more, first.what);
  }
}

}  // namespace rcme
