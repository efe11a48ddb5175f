// The kinds of figures of `rcme plot` and the options of their scripts, for completion.
#pragma once

#include <string>
#include <vector>

namespace rcme {

std::vector<std::string> PlotKinds();

// An option of the script of one or more kinds.
struct PlotOption {
  std::string name, doc;
  bool takes_value = true;
  std::vector<std::string> values = {};  // the allowed values, if they are a short list
};
const std::vector<PlotOption>& PlotOptions();

}  // namespace rcme
