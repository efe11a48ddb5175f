// The kinds of figures of `rcme plot` and the options of their scripts, for completion.
#pragma once

#include <string>
#include <vector>

namespace rcme {

std::vector<std::string> PlotKinds();

// Of one kind or more.
struct PlotOption {
  std::string name, doc;
  bool takes_value = true;
  std::vector<std::string> values = {};  // what it may be, where that is a short list
};
const std::vector<PlotOption>& PlotOptions();

}  // namespace rcme
