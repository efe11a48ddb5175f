// Estimators written in Python: the registry entry `python`, whose option names a function.
#pragma once

#include <pybind11/pybind11.h>

#include <map>
#include <string>

#include "estimator/geometry/camera.h"
#include "estimator/geometry/correspondence.h"
#include "experiments/study/estimator_spec.h"

namespace rcme {

// Adds the entry `python` to the registry. Call it once, before anything reads the registry.
void AddPythonEstimator();

// A function as python/rcme/_function.py passes it: it takes (x1, x2, camera1, camera2, sigma_px,
// noise_scale, seed) and returns a dict with the fields of an OutsideAnswer, whatever the user's own function
// returns.
struct PythonFunction {
  pybind11::function call;
  std::string code;  // hash of its source: a changed function is another estimator
};

// While an object lives, studies can name these functions. At most one at a time; constructed and destroyed
// with the interpreter's lock held.
class FunctionsOfRun {
 public:
  explicit FunctionsOfRun(const std::map<std::string, PythonFunction>& functions);
  ~FunctionsOfRun();
  FunctionsOfRun(const FunctionsOfRun&) = delete;
  FunctionsOfRun& operator=(const FunctionsOfRun&) = delete;
};

// While an object lives, its thread alone can make estimators of these functions, even during a run that has
// others of the same names. Constructed and destroyed with the interpreter's lock held.
class FunctionsOfCall {
 public:
  explicit FunctionsOfCall(const std::map<std::string, PythonFunction>& functions);
  ~FunctionsOfCall();
  FunctionsOfCall(const FunctionsOfCall&) = delete;
  FunctionsOfCall& operator=(const FunctionsOfCall&) = delete;
};

// The estimator of a study that calls this function, labelled with the function's name.
EstimatorSpec SpecOfFunction(const std::string& name, const std::string& code);

// The arguments of Python functions and the results of `simulate`: N x 2 arrays (px), and a camera as the
// dict of PoseLib and pycolmap {model, width, height, params}.
pybind11::object MakePoints(const std::vector<Correspondence>& matches,
                            Eigen::Vector2d Correspondence::*point);
pybind11::dict MakeDict(const Camera& camera);
pybind11::object MakeArray(const Eigen::MatrixXd& matrix);
pybind11::object ScalesOrNone(const MotionProblem& problem);  // None: the noise is equal for all matches

}  // namespace rcme
