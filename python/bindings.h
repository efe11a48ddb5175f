// The parts of the module (module.cc). Each adds what it names.
#pragma once

#include <pybind11/pybind11.h>

namespace rcme {

// `Camera` and `estimate`: one motion from one problem.
void BindEstimate(pybind11::module_& module);

// `audit_json`, `tune` and `conform`.
void BindMethods(pybind11::module_& module);

// Runs of studies and the tables of their results: `run`, `summary_csv`, `comparison_csv`,
// `reliability_json`.
void BindRuns(pybind11::module_& module);

// `conditions`, the conditions of a study, and `simulate`, the matches of a simulated trial.
void BindSimulation(pybind11::module_& module);

}  // namespace rcme
