#include "estimator/conform/conform_estimator.h"

#include <fmt/format.h>

#include <utility>

#include "estimator/estimator_registry.h"
#include "estimator/problem_check.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"

namespace rcme {
namespace {

constexpr const char* kNone = "none";

class ConformedEstimator : public MotionEstimator {
 public:
  ConformedEstimator(std::unique_ptr<MotionEstimator> estimator, ConformRule rule, bool refuses)
      : estimator_(std::move(estimator)), judge_(std::move(rule)), refuses_(refuses) {}

  MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const override {
    return judge_.Apply(problem, estimator_->Estimate(problem, rng), refuses_);
  }

 private:
  std::unique_ptr<MotionEstimator> estimator_;
  ConformJudge judge_;
  bool refuses_;
};

// The estimator without a file: it refuses every problem.
class Unconformed : public MotionEstimator {
 public:
  MotionEstimate Estimate(const MotionProblem& problem, RandomStream&) const override {
    if (std::optional<MotionEstimate> refusal = RefuseUnsolvable(problem, 5)) return *std::move(refusal);
    return MakeRefusal(MotionStatus::kNoAnswer, "no file is given; make one with `rcme conform`");
  }
};

class Model : public EstimatorModel {
 public:
  std::vector<Parameter> Parameters() override {
    return {Parameter::Text("file", &file_, "the path of a file that `rcme conform` wrote",
                            "the estimator and its calibration"),
            Parameter::Text("digest", &digest_, "16 hexadecimal digits",
                            "of the file; a changed file is refused"),
            Parameter::Choice<bool>("accept_rule", &refuses_, {{"apply", true}, {"ignore", false}},
                                    "refuse what the rule does not accept, or only state its probability")};
  }
  void LiftLimits() override { refuses_ = false; }

  std::unique_ptr<MotionEstimator> Make() const override {
    if (file_ == kNone) return std::make_unique<Unconformed>();
    ConformFile file = ReadConformFile(file_);
    if (digest_ != kNone && digest_ != file.digest)
      throw InputError(fmt::format("conform: {} has changed since (digest {}, not {})", Quoted(file_),
                                   file.digest, digest_));
    if (file.rule.estimator == kConformEstimator)
      throw InputError(fmt::format("conform: {} is of `conform` itself", Quoted(file_)));
    std::unique_ptr<MotionEstimator> estimator = MakeEstimator(file.rule.estimator, file.rule.options);
    return std::make_unique<ConformedEstimator>(std::move(estimator), std::move(file.rule), refuses_);
  }

 private:
  std::string file_ = kNone, digest_ = kNone;
  bool refuses_ = true;
};

}  // namespace

std::unique_ptr<EstimatorModel> ConformModel() { return std::make_unique<Model>(); }

Settings ConformOptions(const std::string& path) {
  return {{"file", path}, {"digest", ReadConformFile(path).digest}};
}

}  // namespace rcme
