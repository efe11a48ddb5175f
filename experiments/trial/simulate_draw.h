// Handles conditions that the simulator cannot make. For a chosen condition this is an error; for a draw of
// a population it is an outcome of the trial (MotionStatus::kNotSimulated). Every command that makes trials
// of a study uses this function.
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
  std::optional<T> made;  // empty if it could not be simulated
  std::string why_not;
};

// Returns what `make` returns. If it throws NotSimulated and the study has a population, the result is
// empty.
template <typename Make>
SimulatedDraw<std::invoke_result_t<Make>> SimulateDraw(const Study& study, const Make& make) {
  try {
    return {make(), {}};
  } catch (const NotSimulated& error) {
    if (!study.population) throw;
    return {std::nullopt, error.what()};
  }
}

// Returns a sentence that says how many of the trials were not simulated and that no rate counts them; empty
// if all were simulated.
std::string DescribeNotSimulated(std::int64_t num_not_simulated, std::int64_t num_trials);

}  // namespace rcme
