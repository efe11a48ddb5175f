// The conditions of a study, and the matches of a simulated trial: `conditions` and `simulate`.
#pragma once

#include <pybind11/pybind11.h>

namespace rcme {

void BindSimulation(pybind11::module_& module);

}  // namespace rcme
