// Binds `audit_json`, `tune` and `conform`.
#pragma once

#include <pybind11/pybind11.h>

namespace rcme {

void BindMethods(pybind11::module_& module);

}  // namespace rcme
