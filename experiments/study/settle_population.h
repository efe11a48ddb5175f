// Whether what a population draws can be drawn.
#pragma once

#include "experiments/core/files/yaml_input.h"
#include "experiments/study/study.h"

namespace rcme {

// Throws InputError with the line of `node` unless every key that is drawn exists, and every end of its range
// is allowed, with each scene and law it may be drawn with; also where `data` has a key that one of these
// lacks. Makes single words and numbers what their parameters write.
void SettlePopulation(const Place& place, const YAML::Node& node, Study* study);

// Settings of a draw that there could be: the first word of each choice, beside `data`.
Settings ChooseFirstDraw(const Study& study);

}  // namespace rcme
