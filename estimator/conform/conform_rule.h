// What problems with truth have taught about an estimator's answers, and what is made of a new answer by it:
//
//   region        the stated covariance times a factor of its stratum, so that its ellipsoid at `level` holds
//                 the truth with probability at least `level` (stats/conformal.h), in each stratum. Where no
//                 factor can promise that the region is all motions.
//   probability   that the motion is wrong, from what can be seen of the answer
//   accept rule   answers of a greater probability are refused: P(a problem is answered wrongly, and
//                 accepted) <= `wrong_and_accepted`
//   familiarity   whether the problem is like those
//
// All of it holds for problems exchangeable with those of the calibration: of the same conditions, camera and
// front end. Nothing looks at a truth.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "estimator/conform/visible_features.h"
#include "parameters/settings.h"

namespace rcme {

// intercept + sum over terms of linear z + square (z^2 - 1), z = (feature - centre) / scale moved into [-3,
// 3]; a feature that is NaN adds nothing.
struct FeatureModel {
  struct Term {
    size_t feature = 0;
    double centre = 0.0, scale = 1.0, linear = 0.0, square = 0.0;
  };
  static constexpr double kMostZ = 3.0;

  double intercept = 0.0;
  std::vector<Term> terms;

  double At(const VisibleFeatures& features) const;
};
double ScoreOfFeature(const FeatureModel::Term& term, double feature);  // z; 0 for NaN

// How a calibration was taken; the guarantees are for such problems.
struct ConformOrigin {
  std::string study;
  std::string identity;  // equal for the same problems
  std::int64_t num_answers = 0, num_refusals = 0, num_groups = 0;
  std::int64_t num_refused_groups = 0;  // groups whose first problem was refused
  bool new_groups = false;  // for problems of a new condition or scene; otherwise for others of the same
};

struct ConformRule {
  std::string estimator;  // what it was made for, of the registry, with every option
  Settings options;
  ConformOrigin origin;
  double max_rotation_error_deg = 3.0, max_direction_error_deg = 15.0;  // beyond: the motion is wrong

  double level = 0.95;
  FeatureModel difficulty;      // greater: harder
  std::vector<double> edges;    // of difficulty between strata, rising
  std::vector<double> factors;  // one more, of the covariance; infinite: the region is all motions

  FeatureModel failure;  // log odds of a wrong motion, before they are corrected:
  double log_odds_intercept = 0.0, log_odds_slope = 1.0;

  // Accepted are answers with failure.At at most this; nothing: no threshold keeps the promise.
  std::optional<double> greatest_log_odds;
  double wrong_and_accepted = 0.02, risk = 0.05;  // the promise, and the probability that it does not hold

  // Features of some answers of the calibration, one after the other; NaN: an answer does not have it.
  std::vector<size_t> familiar_features;
  std::vector<double> familiar;
};

inline constexpr double kStrangeLevel = 0.01;  // an answer less familiar than this is called strange

// What the rule says of an answer with a motion.
struct ConformVerdict {
  size_t stratum = 0;
  double factor = 1.0;
  double log_odds = 0.0;             // before they are corrected
  double failure_probability = 0.0;  // corrected
  bool is_accepted = false;
  double familiarity = 1.0;      // p-value: at most a with probability at most a for problems alike
  size_t strangest_feature = 0;  // the one farthest from what is usual
};

// A rule made ready for use. Throws std::invalid_argument for one that is none: sizes that do not agree, NaN.
class ConformJudge {
 public:
  explicit ConformJudge(ConformRule rule);
  const ConformRule& rule() const { return rule_; }

  ConformVerdict Judge(const VisibleFeatures& features) const;
  // Whether there are answers enough to call one strange.
  bool KnowsStrange() const { return static_cast<double>(strangeness_.size() + 1) * kStrangeLevel >= 1.0; }

  // The answer as the rule has it: covariance (of other modes too), probability, domain and message; refused
  // (too_uncertain) where `refuses` and the rule does not accept it, or it is strange. Its domain is not
  // stated where the calibration is too small to call anything strange. What is no motion stays as it is.
  MotionEstimate Apply(const MotionProblem& problem, MotionEstimate estimate, bool refuses) const;

 private:
  struct Usual {
    double median = 0.0, scale = 1.0;
  };
  double Strangeness(const VisibleFeatures& features, size_t* strangest) const;

  ConformRule rule_;
  std::vector<Usual> usual_;         // per familiar feature
  std::vector<double> strangeness_;  // of the calibration, rising
};

// A covariance of whose ellipsoid at any level from .5 on every motion is a part.
Matrix5d CovarianceOfAllMotions();

}  // namespace rcme
