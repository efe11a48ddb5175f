// A rule, learned on problems with known truth, for the answers of an estimator. It gives for a new answer:
//
//   region        the stated covariance times the factor of the answer's stratum. In each stratum, the
//                 ellipsoid at `level` contains the truth with probability at least `level`
//                 (stats/conformal.h). If no factor can promise this, the region is all motions.
//   probability   that the motion is wrong, from the visible features of the answer
//   accept rule   answers with a greater probability are refused: P(a problem is answered wrongly and the
//                 answer is accepted) <= `wrong_and_accepted`
//   familiarity   whether the problem resembles those of the calibration
//
// The guarantees hold for problems that are exchangeable with those of the calibration: the same conditions,
// camera and front end. Applying the rule needs no truth.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "estimator/conform/visible_features.h"
#include "parameters/settings.h"

namespace rcme {

// intercept + sum over terms of linear z + square (z^2 - 1). z = (feature - centre) / scale, clipped to [-3,
// 3]. A feature that is NaN contributes nothing.
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

// The data of the calibration; the guarantees are for such problems.
struct ConformOrigin {
  std::string study;
  // Hashes that name its problems, ascending: of a condition's random streams, or of a real pair's matches.
  std::vector<std::string> problems;
  std::int64_t num_answers = 0, num_refusals = 0, num_groups = 0;
  std::int64_t num_refused_groups = 0;  // groups whose first problem was refused
  // guarantees for problems of a new condition or scene; else for others of the same ones
  bool new_groups = false;
};

struct ConformRule {
  std::string estimator;  // name in the registry; `options` holds every option
  Settings options;
  ConformOrigin origin;
  double max_rotation_error_deg = 3.0, max_direction_error_deg = 15.0;  // beyond either, the motion is wrong

  double level = 0.95;
  FeatureModel difficulty;      // a greater value is harder
  std::vector<double> edges;    // of difficulty between strata, ascending
  std::vector<double> factors;  // of the covariance, one more than edges; infinite: the region is all motions

  FeatureModel failure;  // log-odds of a wrong motion, before their correction:
  double log_odds_intercept = 0.0, log_odds_slope = 1.0;

  // Answers with failure.At at most this are accepted; nullopt: no threshold keeps the promise.
  std::optional<double> greatest_log_odds;
  double wrong_and_accepted = 0.02, risk = 0.05;  // the promise, and the probability that it fails

  // Features of some answers of the calibration, answer by answer; NaN: the answer does not have the feature.
  std::vector<size_t> familiar_features;
  std::vector<double> familiar;
};

inline constexpr double kStrangeLevel = 0.01;  // an answer with a lower familiarity is called strange

// The verdict of the rule on an answer with a motion.
struct ConformVerdict {
  size_t stratum = 0;
  double factor = 1.0;
  double log_odds = 0.0;             // before the correction
  double failure_probability = 0.0;  // after the correction
  bool is_accepted = false;
  double familiarity = 1.0;      // p value; for problems like those of the calibration, P(p <= a) <= a
  size_t strangest_feature = 0;  // the one farthest from its usual value
};

// A rule prepared for use. Throws std::invalid_argument if it is not valid: sizes that do not agree, NaN.
class ConformJudge {
 public:
  explicit ConformJudge(ConformRule rule);

  ConformVerdict Judge(const VisibleFeatures& features) const;
  // Whether there are enough answers to call one strange.
  bool KnowsStrange() const { return static_cast<double>(strangeness_.size() + 1) * kStrangeLevel >= 1.0; }

  // Applies the rule to an answer: sets the covariance (of other modes too), the probability, its domain and
  // the message. If `refuses`, refuses (too_uncertain) an answer that is strange or that the rule does not
  // accept. The domain is not stated if the calibration is too small to call anything strange. An answer
  // without a motion stays unchanged.
  MotionEstimate Apply(const MotionProblem& problem, MotionEstimate estimate, bool refuses) const;

 private:
  struct Usual {
    double median = 0.0, scale = 1.0;
  };
  double Strangeness(const VisibleFeatures& features, size_t* strangest) const;

  ConformRule rule_;
  std::vector<Usual> usual_;         // one per familiar feature
  std::vector<double> strangeness_;  // of the calibration's answers, ascending
};

// A covariance whose ellipsoid contains every motion, at any level of at least .5.
Matrix5d CovarianceOfAllMotions();

}  // namespace rcme
