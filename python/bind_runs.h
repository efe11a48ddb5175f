// Binds runs of studies and the tables of their results: `run`, `summary_csv`, `comparison_csv`,
// `reliability_json`.
#pragma once

#include <pybind11/pybind11.h>

namespace rcme {

void BindRuns(pybind11::module_& module);

}  // namespace rcme
