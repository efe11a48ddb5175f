// Binds `conditions`, the conditions of a study, and `simulate`, the matches of a simulated trial.
#pragma once

#include <pybind11/pybind11.h>

namespace rcme {

void BindSimulation(pybind11::module_& module);

}  // namespace rcme
