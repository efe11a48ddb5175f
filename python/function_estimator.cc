#include "python/function_estimator.h"

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <utility>
#include <vector>

#include "estimator/estimator_registry.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"
#include "peers/outside_answer.h"

namespace rcme {
namespace {

namespace py = pybind11;

constexpr const char* kNone = "none";

// Deletes Python objects with the interpreter's lock held, whichever thread holds the last reference.
struct LetGo {
  void operator()(py::function* function) const {
    const py::gil_scoped_acquire lock;
    delete function;
  }
};
using SharedFunction = std::shared_ptr<py::function>;

struct NamedFunction {
  SharedFunction function;
  std::string code;
};
using NamedFunctions = std::map<std::string, NamedFunction>;

// Never destroyed, since the interpreter may end before static objects do.
NamedFunctions& RunningFunctions() {
  static auto& functions = *new NamedFunctions();
  return functions;
}

// The functions of FunctionsOfCall.
NamedFunctions& FunctionsOfThread() {
  thread_local NamedFunctions functions;
  return functions;
}

void AddTo(NamedFunctions* named, const std::map<std::string, PythonFunction>& functions) {
  for (const auto& [name, function] : functions)
    (*named)[name] = {SharedFunction(new py::function(function.call), LetGo()), function.code};
}

// Null if there is no such function.
const NamedFunction* FindFunction(const std::string& name) {
  for (const NamedFunctions* functions : {&FunctionsOfThread(), &RunningFunctions()}) {
    if (const auto found = functions->find(name); found != functions->end()) return &found->second;
  }
  return nullptr;
}

template <int rows, int cols>
Eigen::Matrix<double, rows, cols> MatrixIn(const py::handle& array) {
  const auto numbers = py::cast<py::array_t<double, py::array::c_style | py::array::forcecast>>(array);
  if (numbers.size() != rows * cols) throw py::value_error("an array of another size");
  using RowMajor = Eigen::Matrix<double, rows, cols, (cols == 1 ? Eigen::ColMajor : Eigen::RowMajor)>;
  return Eigen::Map<const RowMajor>(numbers.data());
}

// _function.py has checked types and shapes.
OutsideAnswer AnswerIn(const py::dict& fields) {
  const auto has = [&](const char* key) { return fields.contains(key) && !fields[key].is_none(); };
  OutsideAnswer answer;
  answer.status = StatusOfOutside(py::cast<std::string>(fields["status"]));
  if (has("message")) answer.message = py::cast<std::string>(fields["message"]);
  if (has("R")) answer.R = MatrixIn<3, 3>(fields["R"]);
  if (has("t")) answer.t = MatrixIn<3, 1>(fields["t"]);
  if (has("pose_cov")) answer.pose_cov = MatrixIn<6, 6>(fields["pose_cov"]);
  if (has("inliers")) answer.inliers = py::cast<std::vector<int>>(fields["inliers"]);
  if (has("p_failure")) answer.failure_probability = py::cast<double>(fields["p_failure"]);
  if (has("sigma")) answer.sigma_px = py::cast<double>(fields["sigma"]);
  if (has("inlier_probabilities"))
    answer.inlier_probabilities = py::cast<std::vector<double>>(fields["inlier_probabilities"]);
  return answer;
}

// Calls of several threads run one after the other, since the interpreter has a single lock.
class FunctionEstimator : public MotionEstimator {
 public:
  explicit FunctionEstimator(SharedFunction function) : function_(std::move(function)) {}

  MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const override {
    return CallOutside(problem, [&] { return Ask(problem, SeedForOutside(rng)); });
  }

 private:
  OutsideAnswer Ask(const MotionProblem& problem, std::uint32_t seed) const {
    const py::gil_scoped_acquire lock;
    try {
      return AnswerIn((*function_)(MakePoints(problem.matches, &Correspondence::x1_px),
                                   MakePoints(problem.matches, &Correspondence::x2_px),
                                   MakeDict(problem.camera1), MakeDict(problem.camera2), problem.sigma_px,
                                   ScalesOrNone(problem), seed));
    } catch (const py::error_already_set& error) {
      throw NoOutsideAnswer(MotionStatus::kLibraryError, error.what());
    } catch (const py::cast_error& error) {
      throw NoOutsideAnswer(MotionStatus::kUnreadableAnswer, error.what());
    } catch (const py::builtin_exception& error) {
      throw NoOutsideAnswer(MotionStatus::kUnreadableAnswer, error.what());
    }
  }

  SharedFunction function_;
};

class FunctionModel : public EstimatorModel {
 public:
  std::vector<Parameter> Parameters() override {
    return {Parameter::Text("function", &function_, "the name of a function given to the call",
                            "a function of Python"),
            Parameter::Text("code", &code_, "a hash", "of the function's source")};
  }
  std::unique_ptr<MotionEstimator> Make() const override {
    const NamedFunction* found = FindFunction(function_);
    if (found == nullptr) {
      throw InputError(fmt::format(
          "estimator python: function {} is not there; give it to the call, estimators={{{}: ...}}",
          Quoted(function_), Quoted(function_)));
    }
    if (code_ != kNone && code_ != found->code) {
      throw InputError(
          fmt::format("estimator python: function {} has changed since (its source has the hash {}, not {})",
                      Quoted(function_), found->code, code_));
    }
    return std::make_unique<FunctionEstimator>(found->function);
  }

 private:
  std::string function_ = kNone, code_ = kNone;
};

}  // namespace

void AddPythonEstimator() {
  AddEstimator({"python", "a function of Python (rcme.run)", [] { return std::make_unique<FunctionModel>(); },
                /*is_peer=*/false, /*is_audited=*/false});
}

FunctionsOfRun::FunctionsOfRun(const std::map<std::string, PythonFunction>& functions) {
  AddTo(&RunningFunctions(), functions);
}

FunctionsOfRun::~FunctionsOfRun() { RunningFunctions().clear(); }

FunctionsOfCall::FunctionsOfCall(const std::map<std::string, PythonFunction>& functions) {
  AddTo(&FunctionsOfThread(), functions);
}

FunctionsOfCall::~FunctionsOfCall() { FunctionsOfThread().clear(); }

EstimatorSpec SpecOfFunction(const std::string& name, const std::string& code) {
  EstimatorSpec spec{name, "python", {}, {}};
  SetOptions(&spec, {{"function", name}, {"code", code}});
  return spec;
}

py::object MakePoints(const std::vector<Correspondence>& matches, Eigen::Vector2d Correspondence::*point) {
  py::array_t<double> points(std::vector<py::ssize_t>{static_cast<py::ssize_t>(matches.size()), 2});
  auto numbers = points.mutable_unchecked<2>();
  for (size_t i = 0; i < matches.size(); ++i) {
    const auto row = static_cast<py::ssize_t>(i);
    numbers(row, 0) = (matches[i].*point).x();
    numbers(row, 1) = (matches[i].*point).y();
  }
  return points;
}

py::object ScalesOrNone(const MotionProblem& problem) {
  const std::vector<double>& scales = problem.noise_scale;
  if (scales.empty()) return py::none();
  return MakeArray(
      Eigen::Map<const Eigen::VectorXd>(scales.data(), static_cast<Eigen::Index>(scales.size())));
}

py::dict MakeDict(const Camera& camera) {
  py::dict dict;
  dict["model"] = "PINHOLE";
  dict["width"] = camera.width;
  dict["height"] = camera.height;
  dict["params"] = std::vector<double>{camera.fx, camera.fy, camera.cx, camera.cy};
  return dict;
}

py::object MakeArray(const Eigen::MatrixXd& matrix) {
  if (matrix.cols() == 1) {
    py::array_t<double> array(matrix.rows());
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) array.mutable_at(i) = matrix(i, 0);
    return array;
  }
  py::array_t<double> array(std::vector<py::ssize_t>{matrix.rows(), matrix.cols()});
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) array.mutable_at(i, j) = matrix(i, j);
  }
  return array;
}

}  // namespace rcme
