#include <pybind11/stl.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "estimator/conform/conform_estimator.h"
#include "estimator/estimator_registry.h"
#include "experiments/audit/claims/audit_output.h"
#include "experiments/audit/claims/audit_work.h"
#include "experiments/audit/claims/case.h"
#include "experiments/audit/claims/claim_table.h"
#include "experiments/audit/claims/study_cases.h"
#include "experiments/audit/claims/study_claims.h"
#include "experiments/conform/conform_output.h"
#include "experiments/conform/conform_report.h"
#include "experiments/conform/conform_words.h"
#include "experiments/study/command_permission.h"
#include "experiments/study/estimator_file.h"
#include "experiments/study/estimator_spec.h"
#include "experiments/tuning/tune_json.h"
#include "experiments/tuning/tune_output.h"
#include "experiments/tuning/tuning_work.h"
#include "parameters/input_error.h"
#include "python/bindings.h"
#include "python/stoppable.h"
#include "python/study_source.h"

namespace rcme {
namespace {

namespace py = pybind11;
using namespace py::literals;

// One check at a time, since checks start threads of their own.
Audit AuditInMemory(const std::vector<Claim>& all, const AuditOptions& options) {
  Runner runner = Runner::InMemory(PlanAuditChecks(PlanAudit(all, options)), 1);
  return RunAudit(all, options, &runner);
}

std::string AuditJson(const StudySource& source, const Functions& functions,
                      const std::vector<std::string>& only, bool is_full, int threads) {
  const FunctionsOfRun of_run(MakeFunctions(functions));
  AuditOptions options;
  options.only = only;
  options.budget = is_full ? Budget::kFull : Budget::kQuick;
  options.num_threads = threads;
  if (source.path.empty() && source.text.empty()) {
    options.seed = source.seed < 0 ? 1 : static_cast<std::uint64_t>(source.seed);
    options.conditions = ResolveCaseSettings({});
    return RunStoppable(
        [&] { return MakeAuditResult(AuditInMemory(AllClaims(EstimatorRegistry()), options)).json; });
  }
  const Study study = LoadSourceStudy(AddFunctions(source, functions));
  RequireCases(study);
  const StudyPlan plan = MakePlan(study, source.Name());
  options.seed = plan.study.seed;
  options.study = plan.study.name;
  options.study_identity = plan.identity;
  options.conditions = plan.study.data;
  return RunStoppable([&] { return MakeAuditResult(AuditInMemory(StudyClaims(plan), options)).json; });
}

// The report of a calibration as JSON, and the file; the file is empty when checking the file `check`.
py::dict Conform(const StudySource& source, const Functions& functions, const std::string& label,
                 const ConformPromise& promise, const std::string& new_problem, const std::string& models,
                 const std::string& check, int threads) {
  const FunctionsOfRun of_run(MakeFunctions(functions));
  Study study = LoadSourceStudy(AddFunctions(source, functions));
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
  const ConformReport report = RunStoppable([&] {
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

// The tuning as JSON, and the file of the tuned estimator; the file is empty if no setting is certified, and
// `why` says why.
py::dict TuneStudy(const StudySource& source, int threads) {
  const Study study = LoadSourceStudy(source);
  if (!study.tuning) throw InputError(source.Name() + ": has no block 'tune' (estimator, target, options)");
  const StudyPlan plan = MakePlan(study, source.Name());
  const SettingPlan settings = MakeSettingPlan(plan.study, *plan.study.tuning);
  const TuningWork work = PlanTuningWork(plan);
  Runner runner = Runner::InMemory(work.items, threads);
  const TuneResult result = RunStoppable([&] {
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

}  // namespace

void BindMethods(py::module_& module) {
  module.def("audit_json", &AuditJson);
  module.def("tune", &TuneStudy);
  module.def("conform",
             [](const StudySource& source, const Functions& functions, const std::string& label, double level,
                double wrong_and_accepted, double risk, const std::string& new_problem,
                const std::string& models, const std::string& check, int threads) {
               return Conform(source, functions, label, {level, wrong_and_accepted, risk}, new_problem,
                              models, check, threads);
             });
}

}  // namespace rcme
