// One motion from one problem: `Camera` and `estimate`.
#pragma once

#include <pybind11/pybind11.h>

namespace rcme {

void BindEstimate(pybind11::module_& module);

}  // namespace rcme
