// Estimators written in Python, beside those of the registry: the entry `python`, whose option names a
// function.
#pragma once

#include <pybind11/pybind11.h>

#include <map>
#include <memory>
#include <string>

#include "estimator/geometry/camera.h"
#include "estimator/geometry/correspondence.h"
#include "experiments/study/estimator_spec.h"

namespace rcme {

// Adds the entry `python` to the table; once, before anything reads it.
void AddPythonEstimator();

// A function as the module's Python half hands it over (python/rcme/_function.py): it takes (x1, x2, camera1,
// camera2, sigma_px, noise_scale, seed) and returns a dict of the fields of an OutsideAnswer, whatever the
// user's own function does.
struct PythonFunction {
  pybind11::function call;
  std::string code;  // a hash of its source: a changed function is another estimator
};

// While one lives, studies can name these functions. One at a time; made and destroyed with the interpreter's
// lock held.
class FunctionsOfRun {
 public:
  explicit FunctionsOfRun(const std::map<std::string, PythonFunction>& functions);
  ~FunctionsOfRun();
  FunctionsOfRun(const FunctionsOfRun&) = delete;
  FunctionsOfRun& operator=(const FunctionsOfRun&) = delete;
};

// While one lives, this thread alone makes estimators of these functions, also in the midst of a run that has
// others of the same names. Made and destroyed with the interpreter's lock held.
class FunctionsOfCall {
 public:
  explicit FunctionsOfCall(const std::map<std::string, PythonFunction>& functions);
  ~FunctionsOfCall();
  FunctionsOfCall(const FunctionsOfCall&) = delete;
  FunctionsOfCall& operator=(const FunctionsOfCall&) = delete;
};

// The estimator of a study that calls the function, labelled by its name.
EstimatorSpec SpecOfFunction(const std::string& name, const std::string& code);

// What functions of Python get, and what `simulate` gives: N x 2 arrays (px), and a camera as a dict of
// PoseLib and pycolmap {model, width, height, params}.
pybind11::object MakePoints(const std::vector<Correspondence>& matches,
                            Eigen::Vector2d Correspondence::*point);
pybind11::dict MakeDict(const Camera& camera);
pybind11::object MakeArray(const Eigen::MatrixXd& matrix);
pybind11::object ScalesOrNone(const MotionProblem& problem);  // None: all matches are alike

}  // namespace rcme
