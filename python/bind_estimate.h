// Binds `Camera` and `estimate`: one motion from one problem.
#pragma once

#include <pybind11/pybind11.h>

namespace rcme {

void BindEstimate(pybind11::module_& module);

}  // namespace rcme
