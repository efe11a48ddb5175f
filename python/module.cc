// The half of the Python package that is C++: rcme._rcme. It takes what python/rcme/*.py has checked;
// docstrings for people are there.
#include <fmt/format.h>
#include <glog/logging.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <filesystem>

#include "estimator/conform/conform_estimator.h"
#include "estimator/estimator_registry.h"
#include "estimator/protection_level.h"
#include "experiments/audit/claims/audit_output.h"
#include "experiments/audit/claims/audit_work.h"
#include "experiments/audit/claims/case.h"
#include "experiments/audit/claims/claim_table.h"
#include "experiments/audit/claims/study_cases.h"
#include "experiments/audit/claims/study_claims.h"
#include "experiments/conform/conform_output.h"
#include "experiments/conform/conform_report.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/files/shared_files.h"
#include "experiments/core/text/program_name.h"
#include "experiments/core/work/stop_request.h"
#include "experiments/data/match_file.h"
#include "experiments/real/answer/probabilities_for_bounds.h"
#include "experiments/run/run_study.h"
#include "experiments/statistics/comparison_output.h"
#include "experiments/statistics/forecast_output.h"
#include "experiments/statistics/summarize_counts.h"
#include "experiments/statistics/summary_output.h"
#include "experiments/study/command_permission.h"
#include "experiments/study/estimator_file.h"
#include "experiments/study/find_estimator.h"
#include "experiments/study/study_file.h"
#include "experiments/trial/answer_check.h"
#include "experiments/trial/severity_columns.h"
#include "experiments/trial/trial.h"
#include "experiments/tuning/tune_json.h"
#include "experiments/tuning/tune_output.h"
#include "experiments/tuning/tuning_work.h"
#include "parameters/input_error.h"
#include "peers/outside_answer.h"
#include "peers/peer_registry.h"
#include "python/function_estimator.h"
#include "stats/constants.h"

namespace rcme {
namespace {

namespace py = pybind11;
using namespace py::literals;

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

// A motion's parts as Python has them: pose_cov is 6x6, of [w, dt] (peers/outside_answer.h).
py::dict DictOfMotion(const RelativePose& pose, const Matrix5d& pose_cov) {
  return py::dict("R"_a = MakeArray(pose.R), "t"_a = MakeArray(pose.t),
                  "pose_cov"_a = MakeArray(CovarianceWithTranslation(pose_cov, pose.t)));
}

// Without a direction: nothing is known of t, in the covariance either.
py::dict DictOfRotation(const MotionEstimate& estimate) {
  Eigen::MatrixXd pose_cov = Eigen::MatrixXd::Constant(6, 6, kNaN);
  pose_cov.topLeftCorner<3, 3>() = estimate.pose_cov.topLeftCorner<3, 3>();
  return py::dict("R"_a = MakeArray(estimate.cam2_from_cam1.R),
                  "t"_a = MakeArray(Eigen::Vector3d::Constant(kNaN)), "pose_cov"_a = MakeArray(pose_cov));
}

py::list MakeModesList(const MotionEstimate& estimate) {
  py::list modes;
  for (const MotionMode& mode : estimate.other_modes) {
    py::dict dict = DictOfMotion(mode.cam2_from_cam1, mode.pose_cov);
    dict["weight"] = mode.weight;
    dict["explained_share"] = mode.explained_share;
    modes.append(dict);
  }
  return modes;
}

py::list MakeProbabilityList(const std::vector<ProbabilityForBounds>& probabilities) {
  py::list list;
  for (const ProbabilityForBounds& each : probabilities)
    list.append(py::dict("rotation_deg"_a = each.bounds.max_rotation_error_deg,
                         "direction_deg"_a = each.bounds.max_direction_error_deg,
                         "p_failure"_a = each.failure_probability, "domain"_a = Name(each.domain)));
  return list;
}

py::dict MakeDict(const MotionEstimate& estimate) {
  py::dict dict("status"_a = StatusName(estimate.status), "message"_a = estimate.message,
                "motion"_a = py::none());
  if (estimate.status == MotionStatus::kOk)
    dict["motion"] = DictOfMotion(estimate.cam2_from_cam1, estimate.pose_cov);
  if (estimate.status == MotionStatus::kDirectionNotObservable) dict["motion"] = DictOfRotation(estimate);
  dict["inliers"] = estimate.inliers;
  dict["p_failure"] = estimate.failure_probability;
  dict["p_failure_domain"] = Name(estimate.probability_domain);
  dict["sigma"] = estimate.sigma_estimated_px;
  dict["sigma_sd"] = estimate.sigma_estimated_sd_px;
  dict["inlier_probabilities"] = estimate.inlier_probabilities;
  dict["other_motions"] = MakeModesList(estimate);
  return dict;
}

// {risk, rotation, direction}, rad; None without a motion.
py::object LevelsAt(const MotionEstimate& estimate, double risk) {
  if (estimate.status != MotionStatus::kOk) return py::none();
  const ProtectionLevels levels = ComputeProtectionLevels(estimate, risk);
  return py::dict("risk"_a = risk, "rotation"_a = levels.rotation_rad, "direction"_a = levels.direction_rad);
}

Camera MakeCamera(const std::array<double, 4>& k, int width, int height) {
  return {k[0], k[1], k[2], k[3], width, height};
}

py::dict Estimate(const Array& x1, const Array& x2, const Camera& camera1, const Camera& camera2,
                  double sigma_px, std::vector<double> noise_scale, const std::string& name,
                  const std::string& file, const Settings& options, std::uint64_t seed, bool allow_process,
                  const std::vector<std::pair<double, double>>& bounds, double integrity_risk) {
  std::vector<EstimatorSpec> specs = {file.empty() ? DefaultEstimator(name) : LoadEstimatorFile(file)};
  EstimatorSpec& spec = specs.front();
  SetOwnOptions(&spec, options);
  if (allow_process) AllowCommands(&specs);
  const std::unique_ptr<MotionEstimator> estimator = Make(spec);
  MotionProblem problem{{}, camera1, camera2, sigma_px, std::move(noise_scale)};
  for (py::ssize_t i = 0; i < x1.shape(0); ++i)
    problem.matches.push_back({{x1.at(i, 0), x1.at(i, 1)}, {x2.at(i, 0), x2.at(i, 1)}});
  std::vector<FailureBounds> failure_bounds;
  for (const auto& [rotation, direction] : bounds) failure_bounds.push_back({rotation, direction});
  EstimateForBounds found;
  {
    const py::gil_scoped_release unlocked;
    RandomStream rng = StreamFor({seed, 0, 0, 0}, StreamPurpose::kSampling);
    found = EstimateWithBounds(*estimator, problem, failure_bounds, rng);
  }
  const MotionEstimate judged = Judged(std::move(found.estimate), problem.matches.size());
  py::dict dict = MakeDict(judged);
  dict["protection_levels"] = LevelsAt(judged, integrity_risk);
  dict["p_failure_for_bounds"] = MakeProbabilityList(found.probabilities);
  dict["estimator"] = spec.label;
  return dict;
}

// A study and what a call changes in it. One that is no file is a text, whose messages call it `study`.
struct StudySource {
  std::string path, text;
  Settings overrides;
  std::int64_t seed = -1, trials = 0;  // the study's own
  std::vector<EstimatorSpec> added;
  bool allow_process = false;  // the commands of the study and of estimator files (command_permission.h)
  std::string Name() const { return path.empty() ? "study" : path; }
};

Study StudyFrom(const StudySource& source) {
  Study study = source.path.empty() ? ParseStudy(source.text, source.Name()) : LoadStudy(source.path);
  for (const EstimatorSpec& spec : source.added) {
    if (std::ranges::count(study.estimators, spec.label, &EstimatorSpec::label) > 0) {
      throw InputError(
          fmt::format("estimators: the study has an estimator '{}' already; give another label", spec.label));
    }
    study.estimators.push_back(spec);
  }
  for (const auto& [key, value] : source.overrides) Override(&study, key, value);
  if (source.seed >= 0) study.seed = static_cast<std::uint64_t>(source.seed);
  if (source.trials > 0) study.trials = static_cast<int>(source.trials);
  if (source.allow_process) AllowCommands(&study.estimators);
  return study;
}

StudyPlan PlanFrom(const StudySource& source, PlanEstimators estimators) {
  return MakePlan(StudyFrom(source), source.Name(), estimators);
}

py::dict MakeLevelsDict(const StudyPlan& plan, const Condition& condition) {
  py::dict levels;
  for (size_t f = 0; f < plan.factor_names.size(); ++f)
    levels[py::str(plan.factor_names[f])] = condition.levels[f];
  return levels;
}

py::list Conditions(const StudySource& source) {
  const StudyPlan plan = PlanFrom(source, PlanEstimators::kNotMade);
  py::list rows;
  for (const Condition& condition : plan.conditions) {
    py::dict row("condition"_a = condition.index);
    for (const auto& [factor, level] : MakeLevelsDict(plan, condition)) row[factor] = level;
    row["trials"] = condition.num_trials;
    rows.append(row);
  }
  return rows;
}

py::dict MakeTruthDict(const TrialData& data) {
  const Truth& truth = data.truth;
  py::dict dict("R"_a = py::none(), "t"_a = py::none(), "inliers"_a = py::none(),
                "undetectable"_a = py::none());
  if (truth.cam2_from_cam1_true) {
    dict["R"] = MakeArray(truth.cam2_from_cam1_true->R);
    if (truth.is_direction_known) dict["t"] = MakeArray(truth.cam2_from_cam1_true->t);
  }
  if (!truth.is_inlier_true.empty()) dict["inliers"] = py::array(py::cast(truth.is_inlier_true));
  if (!truth.is_undetectable.empty()) dict["undetectable"] = py::array(py::cast(truth.is_undetectable));
  return dict;
}

py::dict Simulate(const StudySource& source, std::int64_t condition_index, std::int64_t trial) {
  const StudyPlan plan = PlanFrom(source, PlanEstimators::kNotMade);
  if (condition_index >= static_cast<std::int64_t>(plan.conditions.size())) {
    throw InputError(fmt::format("condition: {} is not allowed; the study has conditions 0 to {}",
                                 condition_index, plan.conditions.size() - 1));
  }
  const Condition& condition = plan.conditions[static_cast<size_t>(condition_index)];
  const StreamName name = NameOfScene(plan, condition, static_cast<std::uint32_t>(trial));
  const TrialData data = condition.source->Make(name);
  const MotionProblem& problem = data.problem;
  py::dict severity;
  for (const SeverityColumn& column : kSeverityColumns) severity[column.name] = data.severity.*column.field;
  return py::dict("x1"_a = MakePoints(problem.matches, &Correspondence::x1_px),
                  "x2"_a = MakePoints(problem.matches, &Correspondence::x2_px),
                  "camera1"_a = MakeDict(problem.camera1), "camera2"_a = MakeDict(problem.camera2),
                  "sigma_px"_a = problem.sigma_px, "noise_scale"_a = ScalesOrNone(problem),
                  "truth"_a = MakeTruthDict(data), "severity"_a = severity,
                  "levels"_a = MakeLevelsDict(plan, condition), "origin"_a = data.origin,
                  "weight"_a = data.weight, "condition"_a = condition.index, "trial"_a = trial);
}

// Work that may be stopped: Ctrl-C is an exception of Python once what is in hand is kept.
template <typename Work>
auto Stoppable(Work work) {
  const StopOnSignals stop;
  try {
    const py::gil_scoped_release unlocked;
    return work();
  } catch (const Stopped& stopped) {
    const bool is_interrupt = StopExitCode() == 128 + SIGINT;
    stop_signal = 0;  // the next call is not stopped by it
    PyErr_SetString(is_interrupt ? PyExc_KeyboardInterrupt : PyExc_SystemExit, stopped.what());
    throw py::error_already_set();
  }
}

using Functions = std::map<std::string, std::pair<py::function, std::string>>;

std::map<std::string, PythonFunction> FunctionsIn(const Functions& given) {
  std::map<std::string, PythonFunction> functions;
  for (const auto& [name, function] : given) functions[name] = {function.first, function.second};
  return functions;
}

// The source with the functions as estimators, in front of those that it adds by name.
StudySource WithFunctions(StudySource source, const Functions& functions) {
  std::vector<EstimatorSpec> added;
  for (const auto& [name, function] : functions) added.push_back(SpecOfFunction(name, function.second));
  source.added.insert(source.added.begin(), added.begin(), added.end());
  return source;
}

py::dict Run(const StudySource& source, const Functions& functions, int threads, const std::string& out) {
  const FunctionsOfRun of_run(FunctionsIn(functions));
  const StudyPlan plan = PlanFrom(WithFunctions(source, functions), PlanEstimators::kMade);
  const RunReport report = Stoppable([&] {
    ResultStore store = ResultStore::OpenForRun(out, plan);
    return RunStudy(plan, threads, &store);
  });
  return py::dict("num_trials"_a = report.num_trials, "num_run_now"_a = report.num_run_now,
                  "seconds"_a = report.seconds);
}

std::string SummaryCsv(const std::string& run, bool with_times, bool is_pooled) {
  const Pooling pooling = is_pooled ? Pooling::kPooled : Pooling::kPerCondition;
  const py::gil_scoped_release unlocked;
  return SummaryAsCsv(KeepsCounts(run) ? SummarizeCounts(OpenCounts(run), with_times, pooling)
                                       : Summarize(ResultStore::OpenForReading(run), with_times, pooling));
}

std::string ComparisonCsv(const std::string& run, const std::string& against,
                          const std::vector<std::string>& of, bool is_anytime_valid, bool is_pooled) {
  const py::gil_scoped_release unlocked;
  const CompareOptions options{of, is_pooled ? Pooling::kPooled : Pooling::kPerCondition, is_anytime_valid};
  const Comparison comparison = Compare(ResultStore::OpenForReading(run), against, options);
  if (comparison.rows.empty()) {
    throw InputError(comparison.caution.empty() ? run + ": one estimator; a comparison needs two"
                                                : run + ": " + comparison.caution);
  }
  return ComparisonAsCsv(comparison);
}

std::string ReliabilityJson(const std::string& run, const std::string& by) {
  const py::gil_scoped_release unlocked;
  std::vector<ResultStore> runs;
  runs.push_back(ResultStore::OpenForReading(run));
  return ForecastsAsJson(runs.front().Description().study, by, MeasureFailureForecasts(runs, by));
}

// Checks have threads of their own: one at a time.
Audit AuditInMemory(const std::vector<Claim>& all, const AuditOptions& options) {
  Runner runner = Runner::InMemory(PlanAuditChecks(PlanAudit(all, options)), 1);
  return RunAudit(all, options, &runner);
}

std::string AuditJson(const StudySource& source, const Functions& functions,
                      const std::vector<std::string>& only, bool is_full, int threads) {
  const FunctionsOfRun of_run(FunctionsIn(functions));
  AuditOptions options;
  options.only = only;
  options.budget = is_full ? Budget::kFull : Budget::kQuick;
  options.num_threads = threads;
  if (source.path.empty() && source.text.empty()) {
    options.seed = source.seed < 0 ? 1 : static_cast<std::uint64_t>(source.seed);
    options.conditions = ResolveCaseSettings({});
    return Stoppable([&] { return AuditAsJson(AuditInMemory(AllClaims(EstimatorRegistry()), options)); });
  }
  const Study study = StudyFrom(WithFunctions(source, functions));
  RequireCases(study);
  const StudyPlan plan = MakePlan(study, source.Name());
  options.seed = plan.study.seed;
  options.study = plan.study.name;
  options.study_identity = plan.identity;
  options.conditions = plan.study.data;
  return Stoppable([&] { return AuditAsJson(AuditInMemory(StudyClaims(plan), options)); });
}

// The report of a calibration as JSON, and the file: empty for a check of the file `check`.
py::dict Conform(const StudySource& source, const Functions& functions, const std::string& label,
                 const ConformPromise& promise, const std::string& new_problem, const std::string& models,
                 const std::string& check, int threads) {
  const FunctionsOfRun of_run(FunctionsIn(functions));
  Study study = StudyFrom(WithFunctions(source, functions));
  RequireFixedOptions(study, "a calibration");
  std::vector<EstimatorSpec> asked = {
      check.empty() ? study.estimators.at(FindEstimator(study.estimators, label, source.Name()))
                    : LoadConformedEstimator(check)};
  if (source.allow_process) AllowCommands(&asked);
  study.estimators = asked;
  bool has_new_groups = new_problem == "condition";
  if (!check.empty()) {
    const ConformRule rule = ReadConformFile(check).rule;
    study.failure = {rule.max_rotation_error_deg, rule.max_direction_error_deg};
    has_new_groups = has_new_groups || rule.origin.new_groups;
  }
  const StudyPlan plan = MakePlan(study, source.Name());
  const NewProblem chosen = has_new_groups           ? NewProblem::kCondition
                            : new_problem == "trial" ? NewProblem::kTrial
                                                     : UsualNewProblem(plan);
  Runner runner = Runner::InMemory(PlanCalibration(plan), threads);
  std::string file;
  const ConformReport report = Stoppable([&] {
    GetCalibration(plan, &runner);
    const AnswerRows answers = ReadCalibration(plan, chosen, runner);
    if (!check.empty()) return CheckConform(plan, LoadToCheck(plan, check), answers);
    const std::optional<ConformRule> trained = LoadModels(plan, models);
    ConformReport made = CalibrateConform(plan, chosen, promise, trained ? &*trained : nullptr, answers);
    file = ConformFileText(made.rule, DescribePromises(made.rule));
    return made;
  });
  return py::dict("json"_a = ConformAsJson(report), "file"_a = file);
}

// The tuning as JSON, and the tuned estimator's file: empty where none is certified, with the reason why.
py::dict TuneStudy(const StudySource& source, int threads) {
  const Study study = StudyFrom(source);
  if (!study.tuning) throw InputError(source.Name() + ": has no block 'tune' (estimator, target, options)");
  const StudyPlan plan = MakePlan(study, source.Name());
  const SettingPlan settings = MakeSettingPlan(plan.study, *plan.study.tuning);
  const TuningWork work = PlanTuningWork(plan);
  Runner runner = Runner::InMemory(work.items, threads);
  const TuneResult result = Stoppable([&] {
    GetTuningResults(plan, settings, work, Unreached::kVerifyAll, &runner);
    return Tune(plan, settings, Unreached::kVerifyAll, CountsIn(plan, settings, work, runner.results()));
  });
  std::string file;
  if (result.choice.setting) {
    EstimatorSpec spec = settings.settings[*result.choice.setting].spec;
    spec.label += "_tuned";
    file = EstimatorFileText(spec, DescribeProvenance(plan, result));
  }
  return py::dict("json"_a = TuneAsJson(plan, settings, result, {}), "file"_a = file,
                  "why"_a = result.choice.why);
}

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

void AddStudySource(py::module_& module) {
  py::class_<StudySource>(module, "StudySource")
      .def(py::init([](const std::string& path, const std::string& text, const Settings& overrides,
                       std::int64_t seed, std::int64_t trials, bool allow_process) {
        return StudySource{path, text, overrides, seed, trials, {}, allow_process};
      }))
      .def("add_estimator",
           [](StudySource& source, const std::string& label, const std::string& name,
              const Settings& options) {
             EstimatorSpec spec = DefaultEstimator(name);
             SetOwnOptions(&spec, options);
             if (!label.empty()) spec.label = label;
             // Throws where two options contradict each other. What one conforms may be a function, or a
             // command that nobody has allowed yet: the plan makes it.
             if (spec.name != kConformEstimator) Make(spec);
             source.added.push_back(spec);
           })
      .def("add_estimator_file", [](StudySource& source, const std::string& label, const std::string& path) {
        EstimatorSpec spec = LoadEstimatorFile(path);
        if (!label.empty()) spec.label = label;
        source.added.push_back(spec);
      });
}

}  // namespace

PYBIND11_MODULE(_rcme, module) {
  FLAGS_minloglevel = google::GLOG_FATAL;  // Ceres reports through its summary; outcomes have names here
  NameProgram("rcme_python");
  AddPeers();
  AddOutsideEstimators();
  AddPythonEstimator();
  module.attr("__version__") = RCME_VERSION;
  py::register_exception_translator([](std::exception_ptr pointer) {
    try {
      if (pointer) std::rethrow_exception(pointer);
    } catch (const InputError& error) {
      PyErr_SetString(PyExc_ValueError, error.what());
    } catch (const std::filesystem::filesystem_error& error) {
      PyErr_SetString(PyExc_ValueError, error.what());
    }
  });
  py::class_<Camera>(module, "Camera").def(py::init(&MakeCamera));
  AddStudySource(module);
  module.def("use_share", &UseShare);
  module.def("estimate", &Estimate);
  module.def("conditions", &Conditions);
  module.def("simulate", &Simulate);
  module.def("run", &Run);
  module.def("summary_csv", &SummaryCsv);
  module.def("comparison_csv", &ComparisonCsv);
  module.def("reliability_json", &ReliabilityJson);
  module.def("audit_json", &AuditJson);
  module.def("tune", &TuneStudy);
  module.def("conform",
             [](const StudySource& source, const Functions& functions, const std::string& label, double level,
                double wrong_and_accepted, double risk, const std::string& new_problem,
                const std::string& models, const std::string& check, int threads) {
               return Conform(source, functions, label, {level, wrong_and_accepted, risk}, new_problem,
                              models, check, threads);
             });
  module.def("write_file", &WriteFileWhole);
  module.def("estimators", &Estimators);
}

}  // namespace rcme
