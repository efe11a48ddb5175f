// Checks that the ranges of a population are possible.
#pragma once

#include <fmt/format.h>

#include "experiments/core/files/yaml_input.h"
#include "experiments/study/study.h"
#include "parameters/input_error.h"

namespace rcme {

// Runs `check` and adds the place of the key to an InputError from it.
template <typename Check>
void AtKey(const DrawnKey& drawn, Check check) {
  try {
    check();
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", drawn.place, error.what()));
  }
}

// Throws InputError with the line of `node` unless every drawn key exists, and both ends of its range are
// allowed, with every scene and law with which it may be drawn. A key in `data` that one of these lacks is
// an error too. Words and fixed numbers become canonical: as their parameters format them.
void SettlePopulation(const Place& place, const YAML::Node& node, Study* study);

// Returns the settings of a possible draw: `data` and the first word of each choice.
Settings ChooseFirstDraw(const Study& study);

}  // namespace rcme
