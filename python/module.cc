// The C++ part of the Python package, rcme._rcme. Its arguments were checked by python/rcme/*.py, which also
// has the docstrings for users.
#include <glog/logging.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>

#include "estimator/estimator_registry.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/files/shared_files.h"
#include "experiments/core/text/program_name.h"
#include "parameters/input_error.h"
#include "peers/peer_registry.h"
#include "python/bindings.h"
#include "python/function_estimator.h"
#include "python/study_source.h"

namespace rcme {
namespace {

namespace py = pybind11;

py::list Estimators() {
  py::list all;
  for (const EstimatorEntry& entry : EstimatorRegistry()) {
    const std::unique_ptr<EstimatorModel> model = entry.make();
    py::dict options;
    for (const Parameter& option : model->Parameters())
      options[py::str(option.name())] =
          py::make_tuple(option.Value(), option.unit(), option.allowed(), option.doc());
    all.append(py::make_tuple(entry.name, entry.doc, options));
  }
  return all;
}

// A message about an option of the program ("--of: ...") as one about the argument of the same name.
std::string NameArgument(const std::string& message) {
  if (!message.starts_with("--")) return message;
  const size_t end = std::min(message.find_first_of(": "), message.size());
  std::string name = message.substr(2, end - 2);
  std::ranges::replace(name, '-', '_');
  return (name == "set" ? "overrides" : name) + message.substr(end);
}

}  // namespace

PYBIND11_MODULE(_rcme, module) {
  FLAGS_minloglevel = google::GLOG_FATAL;  // Ceres reports through its summary
  NameProgram("rcme");
  AddPeers();
  AddOutsideEstimators();
  AddPythonEstimator();
  module.attr("__version__") = RCME_VERSION;
  py::register_exception_translator([](std::exception_ptr pointer) {
    try {
      if (pointer) std::rethrow_exception(pointer);
    } catch (const InputError& error) {
      PyErr_SetString(PyExc_ValueError, NameArgument(error.what()).c_str());
    } catch (const std::filesystem::filesystem_error& error) {
      PyErr_SetString(PyExc_ValueError, error.what());
    }
  });
  BindStudySource(module);
  module.def("use_share", &UseShare);
  BindEstimate(module);
  BindSimulation(module);
  BindRuns(module);
  BindMethods(module);
  module.def("write_file", &WriteFileWhole);
  module.def("estimators", &Estimators);
}

}  // namespace rcme
