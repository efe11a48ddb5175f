// What the simulator cannot make: an error where somebody has chosen the condition, an outcome of the trial
// (MotionStatus::kNotSimulated) where the condition is a draw of a population. Every command that makes
// trials of a study goes through here.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>

#include "experiments/data/data_source.h"
#include "experiments/study/study.h"

namespace rcme {

template <typename T>
struct SimulatedDraw {
  std::optional<T> made;  // nothing: it could not be simulated
  std::string why_not;
};

// What `make` returns; nothing where it throws NotSimulated and the study's conditions are draws.
template <typename Make>
SimulatedDraw<std::invoke_result_t<Make>> SimulateDraw(const Study& study, const Make& make) {
  try {
    return {make(), {}};
  } catch (const NotSimulated& error) {
    if (!study.population) throw;
    return {std::nullopt, error.what()};
  }
}

// A sentence that says how many of some trials were not simulated, and that no rate counts them. Empty: none.
std::string DescribeNotSimulated(std::int64_t num_not_simulated, std::int64_t num_trials);

}  // namespace rcme
