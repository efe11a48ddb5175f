// What is suspicious about an input that can be used all the same: a camera, a key of a header.
#pragma once

#include <string>
#include <vector>

namespace rcme {

struct InputDoubt {
  std::string place;  // a file with line and key, or an option
  std::string what;   // what is suspicious, and what to do
};

// Collects the doubts about many files and reports each once.
class InputWarnings {
 public:
  void Add(const std::vector<InputDoubt>& doubts);
  // Prints "warning: PLACE (and 12 more): what" for each, in the order of their first places.
  void Print() const;

 private:
  struct Warning {
    InputDoubt first;
    int count = 0;
  };
  std::vector<Warning> warnings_;
};

}  // namespace rcme
