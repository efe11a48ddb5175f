#include "experiments/truth_free/twin_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "estimator/geometry/essential_matrix.h"
#include "estimator/geometry/sampson.h"
#include "experiments/base/columns.h"
#include "experiments/base/field_text.h"
#include "experiments/base/stop_request.h"
#include "experiments/data/make_data.h"
#include "experiments/trial/answer_check.h"
#include "experiments/trial/trial.h"
#include "experiments/truth_free/halves.h"
#include "experiments/truth_free/residual_correlation.h"
#include "experiments/truth_free/twin.h"
#include "parameters/input_error.h"
#include "stats/distributions.h"
#include "stats/shared_members.h"

namespace rcme {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kDegPerRad = 57.29577951308232;
constexpr double kLeastProducts = 20.0;  // of residuals, for the correlation of a pair
constexpr double kTailSigmas = 2.0;
constexpr std::int64_t kLeastPairs = 3;  // for a mean to be compared

enum Quantity : size_t {
  kRefusal,
  kFailure,
  kStatedFailure,
  kSigma,
  kAcceptedShare,
  kInlierTest,
  kTailShare,
  kRotationSd,
  kDirectionSd,
  kSpatialHalves,
  kRandomHalves,
  kNearCorrelation,
  kFarCorrelation,
  kNumQuantities
};
struct QuantityText {
  const char* name;
  bool is_rate;
  const char* words;
  const char* missing;  // what simulation may lack where it is not met
};
constexpr std::array<QuantityText, kNumQuantities> kTexts = {{
    {"refusal", true, "no motion, of all pairs",
     "scenes near what the estimator refuses: planes, little parallax"},
    {"failure", true, "motion beyond 3 deg or 15 deg, of pairs whose motion is known",
     "wrong matches that agree with each other, or a given truth that is wrong"},
    {"stated_failure", false, "stated probability of failure, mean",
     "wrong matches that agree with each other"},
    {"sigma_px", false, "noise estimated from the residuals (px), mean",
     "noise that differs from pair to pair"},
    {"accepted_share", false, "matches accepted, of all, mean", "wrong matches near the epipolar lines"},
    {"inlier_test", false,
     "accepted matches over those within 4 estimated sigma of their epipolar lines, mean",
     "tails of the noise, or matches with noise of their own (key-point size)"},
    {"tail_share", false, "accepted residuals beyond 2 estimated sigma, mean", "tails of the noise"},
    {"rotation_sd_deg", false, "stated standard deviation of the rotation (deg), geometric mean",
     "noise that differs from pair to pair"},
    {"direction_sd_deg", false, "stated standard deviation of the direction (deg), geometric mean",
     "noise that differs from pair to pair"},
    {"spatial_halves", true, "left/right and upper/lower halves within the 95 % region of their difference",
     "errors common to a part of the image: calibration, distortion, rolling shutter, texture"},
    {"random_halves", true, "random halves within the 95 % region of their difference",
     "wrong matches among the accepted, several motions"},
    {"near_correlation", false, "correlation of residuals up to 1 px apart, mean",
     "points that were found twice"},
    {"far_correlation", false, "correlation of residuals 4 to 16 px apart, mean",
     "errors common to neighbours: texture, distortion"},
}};

// The values of one pair, or of one twin: none, one or several of each quantity.
using Values = std::array<std::vector<double>, kNumQuantities>;

void AddHalves(const MotionProblem& problem, const MotionEstimate& whole, const MotionEstimator& estimator,
               StreamName name, Values* values) {
  static const double bound = ChiSquareQuantile(5, 0.95);
  const auto add = [&](Split split, Quantity quantity) {
    ++name.trial;
    const std::optional<double> difference = DifferenceOfHalves(problem, whole, split, estimator, name);
    if (difference) (*values)[quantity].push_back(*difference <= bound);
  };
  for (const Split split : kSpatialSplits) add(split, kSpatialHalves);
  for (const Split split : kRandomSplits) add(split, kRandomHalves);
}

void AddResiduals(const MotionProblem& problem, const MotionEstimate& estimate, Values* values) {
  const Eigen::Matrix3d F =
      FundamentalFromEssential(EssentialFromPose(estimate.cam2_from_cam1), problem.camera1, problem.camera2);
  const double sigma_px = NoiseOf(problem, estimate);
  (*values)[kSigma].push_back(sigma_px);
  double num_beyond = 0.0;
  for (const int i : estimate.inliers) {
    const double squared = SquaredSampsonDistance(F, problem.matches[static_cast<size_t>(i)]);
    num_beyond += squared > kTailSigmas * sigma_px * kTailSigmas * sigma_px;
  }
  double num_near = 0.0;
  for (const Correspondence& match : problem.matches)
    num_near += SquaredSampsonDistance(F, match) <= kRightWithin * sigma_px * kRightWithin * sigma_px;
  const double num_inliers = static_cast<double>(estimate.inliers.size());
  if (num_near > 0.0) (*values)[kInlierTest].push_back(num_inliers / num_near);
  (*values)[kTailShare].push_back(num_beyond / num_inliers);
  (*values)[kAcceptedShare].push_back(num_inliers / static_cast<double>(problem.matches.size()));
  const ResidualProducts products = ProductsOf(problem, estimate);
  for (const auto& [quantity, distance] :
       {std::pair{kNearCorrelation, size_t{0}}, {kFarCorrelation, size_t{2}}}) {
    if (products.counts[distance] >= kLeastProducts)
      (*values)[quantity].push_back(products.Correlation(distance));
  }
}

Values ValuesOf(const TrialData& trial, const MotionEstimate& estimate, const MotionEstimator& estimator,
                const StreamName& name) {
  Values values;
  const TrialRecord record = Score(estimate, trial, 0.0);
  values[kRefusal].push_back(HasRefused(record));
  if (trial.truth.cam2_from_cam1_true) values[kFailure].push_back(HasFailed(record, FailureBounds()));
  if (estimate.status != MotionStatus::kOk || estimate.inliers.empty()) return values;
  if (std::isfinite(estimate.failure_probability))
    values[kStatedFailure].push_back(estimate.failure_probability);
  AddResiduals(trial.problem, estimate, &values);
  const Vector5d variances = estimate.pose_cov.diagonal();
  values[kRotationSd].push_back(std::log(kDegPerRad * std::sqrt(variances.head<3>().sum())));
  values[kDirectionSd].push_back(std::log(kDegPerRad * std::sqrt(variances.tail<2>().sum())));
  AddHalves(trial.problem, estimate, estimator, name, &values);
  return values;
}

double MeanOf(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double x : values) sum += x;
  return sum / static_cast<double>(values.size());
}

// The pairs of a scene with numbers of their images, what was observed, and what the twins of each gave.
struct ComparedPair {
  std::int64_t image1 = 0, image2 = 0;
  Values observed, twins;
};

std::vector<PairEvent> EventsOf(const std::vector<ComparedPair>& pairs, size_t quantity) {
  std::vector<PairEvent> events;
  for (const ComparedPair& pair : pairs) {
    for (const double x : pair.observed[quantity]) events.push_back({pair.image1, pair.image2, x != 0.0});
  }
  return events;
}

// Of a mean: observed values less what is predicted for the same pair, or for all where twins are not of one.
std::vector<PairValue> DifferencesOf(const std::vector<ComparedPair>& pairs, size_t quantity, bool is_paired,
                                     double prediction) {
  std::vector<PairValue> differences;
  for (const ComparedPair& pair : pairs) {
    const std::vector<double>& twins = pair.twins[quantity];
    if (pair.observed[quantity].empty() || (is_paired && twins.empty())) continue;
    const double predicted = is_paired ? MeanOf(twins) : prediction;
    differences.push_back({pair.image1, pair.image2, MeanOf(pair.observed[quantity]) - predicted});
  }
  return differences;
}

// The mean of what twins gave; of paired ones over the pairs that gave something too.
double PredictionOf(const std::vector<ComparedPair>& pairs, size_t quantity, bool is_paired_mean) {
  std::vector<double> all;
  for (const ComparedPair& pair : pairs) {
    const std::vector<double>& twins = pair.twins[quantity];
    if (!is_paired_mean)
      all.insert(all.end(), twins.begin(), twins.end());
    else if (!twins.empty() && !pair.observed[quantity].empty())
      all.push_back(MeanOf(twins));
  }
  return all.empty() ? kNaN : MeanOf(all);
}

std::optional<TwinComparison> Compared(const std::vector<ComparedPair>& pairs, size_t quantity,
                                       const std::string& twin, double confidence) {
  const QuantityText& text = kTexts[quantity];
  const bool is_paired = twin == "semi_real" && !text.is_rate;
  TwinComparison compared{text.name, twin, text.is_rate, 0, kNaN, PredictionOf(pairs, quantity, is_paired),
                          {}};
  if (std::isnan(compared.predicted)) return std::nullopt;
  if (text.is_rate) {
    const SharedMemberRate rate = MeasureSharedMemberRate(EventsOf(pairs, quantity), confidence);
    if (rate.n == 0) return std::nullopt;
    compared.n = rate.n;
    compared.observed = rate.rate;
    compared.joint = rate.interval;
    return compared;
  }
  const SharedMemberMean mean =
      MeasureSharedMemberMean(DifferencesOf(pairs, quantity, is_paired, compared.predicted), confidence);
  if (mean.n < kLeastPairs) return std::nullopt;
  compared.n = mean.n;
  compared.observed = compared.predicted + mean.value;
  compared.joint = {compared.predicted + mean.interval.lower, compared.predicted + mean.interval.upper};
  if (quantity == kRotationSd || quantity == kDirectionSd) {
    for (double* x : {&compared.observed, &compared.predicted, &compared.joint.lower, &compared.joint.upper})
      *x = std::exp(*x);
  }
  return compared;
}

void AddComparisons(const std::vector<ComparedPair>& pairs, const std::string& twin, TwinReport* report) {
  size_t num_compared = 0;
  for (size_t q = 0; q < kNumQuantities; ++q) num_compared += Compared(pairs, q, twin, 0.95).has_value();
  const double confidence = 1.0 - 0.05 / static_cast<double>(std::max<size_t>(num_compared, 1));
  for (size_t q = 0; q < kNumQuantities; ++q) {
    const std::optional<TwinComparison> compared = Compared(pairs, q, twin, confidence);
    if (compared) report->comparisons.push_back(*compared);
  }
}

Values Joined(Values a, const Values& b) {
  for (size_t q = 0; q < kNumQuantities; ++q) a[q].insert(a[q].end(), b[q].begin(), b[q].end());
  return a;
}

constexpr std::uint32_t kCallsOfOne = 8;  // numbers of trials: a pair's own calls, then those of each twin

Values TwinValues(const TrialData& twin, const MotionEstimator& estimator, const StreamName& name) {
  RandomStream rng = StreamFor(name, StreamPurpose::kSampling);
  const MotionEstimate estimate = Judged(estimator.Estimate(twin.problem, rng), twin.problem.matches.size());
  return ValuesOf(twin, estimate, estimator, name);
}

std::vector<ComparedPair> ObservedOf(const TwinSource& source, const MotionEstimator& estimator,
                                     std::uint64_t seed) {
  std::map<std::string, std::int64_t> numbers;
  const auto number_of = [&](const std::string& image, const std::string& otherwise) {
    const std::string& name = image.empty() ? otherwise : image;
    return numbers.try_emplace(name, static_cast<std::int64_t>(numbers.size())).first->second;
  };
  std::vector<ComparedPair> pairs;
  for (const AnsweredTrial& one : source.pairs) {
    if (IsStopRequested()) throw Stopped("stopped; nothing more is written");
    ComparedPair pair{number_of(one.image1, one.pair.origin + "/1"),
                      number_of(one.image2, one.pair.origin + "/2"),
                      ValuesOf(one.pair, one.estimate, estimator, {seed, StreamKeyOf(one.pair.origin), 0, 0}),
                      {}};
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

std::string NumberText(const TwinComparison& c, double x) {
  return c.is_rate ? fmt::format("{:.1f} %", 100.0 * x) : fmt::format("{:.3g}", x);
}

std::string NoiseInWords(const RedrawSettings& noise) {
  std::string text = fmt::format("{:.3g} px", noise.noise_px);
  text += noise.student_dof == 0 ? ", normal" : fmt::format(", Student's t of {}", noise.student_dof);
  if (noise.near_share >= 0.005)
    text += fmt::format(", {:.0f} % common within 1 px", 100.0 * noise.near_share);
  if (noise.far_share >= 0.005)
    text += fmt::format(", {:.0f} % within {:g} px", 100.0 * noise.far_share, noise.far_length_px);
  return text;
}

std::string FitInWords(const TwinReport& report) {
  const TwinFit& fit = report.fit;
  return fmt::format(
      "{}: {} pairs, {} with a geometry to resemble\n  noise {}; {} matches, {:.0f} % wrong ({:.0f} % of "
      "those move "
      "as a neighbour)\n  rotation {:.2g} deg, parallax {:.2g} deg, |t_z| {:.2f}, depths {:.2g} to {:.2g} "
      "baselines, one plane explains {:.0f} %, Clark-Evans {:.2f}\n",
      report.scene, report.num_pairs, fit.num_templates, NoiseInWords(fit.noise), fit.num_matches,
      100.0 * fit.wrong_share, 100.0 * fit.wrong_agreeing_share, fit.rotation_deg, fit.parallax_deg,
      fit.forwardness, fit.nearest, fit.farthest, 100.0 * fit.homography_share, fit.clark_evans);
}

const TwinComparison* Find(const TwinReport& report, const std::string& quantity, const std::string& twin) {
  for (const TwinComparison& c : report.comparisons) {
    if (c.quantity == quantity && c.twin == twin) return &c;
  }
  return nullptr;
}

std::string ReportAsText(const TwinReport& report) {
  std::vector<std::vector<std::string>> rows = {
      {"quantity", "n", "semi-real", "observed [joint 95 %]", "", "simulated", "observed [joint 95 %]", ""}};
  std::string missed;
  for (const QuantityText& text : kTexts) {
    std::vector<std::string> row = {text.name, ""};
    for (const char* twin : {"semi_real", "simulated"}) {
      const TwinComparison* c = Find(report, text.name, twin);
      if (c == nullptr) {
        row.insert(row.end(), {"-", "-", ""});
        continue;
      }
      row[1] = fmt::format("{}", c->n);
      row.insert(row.end(), {NumberText(*c, c->predicted),
                             fmt::format("{} [{}, {}]", NumberText(*c, c->observed),
                                         NumberText(*c, c->joint.lower), NumberText(*c, c->joint.upper)),
                             c->IsWithin() ? "within" : "NOT"});
      if (!c->IsWithin() && c->twin == "semi_real")
        missed += fmt::format("  not explained: {}: {}\n", text.words, text.missing);
    }
    if (row[1].empty()) continue;
    rows.push_back(row);
  }
  std::string text = FitInWords(report) + FormatColumns(rows);
  text += fmt::format("  within: semi-real {} of {}", report.NumWithin("semi_real"),
                      report.NumCompared("semi_real"));
  text += report.simulated.empty() ? fmt::format("; no simulated scene: {}\n", report.why_not_simulated)
                                   : fmt::format(", simulated {} of {}\n", report.NumWithin("simulated"),
                                                 report.NumCompared("simulated"));
  return text + missed + "\n";
}

}  // namespace

std::string TwinQuantityInWords(const std::string& quantity) {
  return std::ranges::find(kTexts, quantity, [](const QuantityText& t) { return std::string(t.name); })
      ->words;
}

std::string WhatMayBeMissing(const std::string& quantity) {
  return std::ranges::find(kTexts, quantity, [](const QuantityText& t) { return std::string(t.name); })
      ->missing;
}

int TwinReport::NumCompared(const std::string& twin) const {
  return static_cast<int>(std::ranges::count(comparisons, twin, &TwinComparison::twin));
}

int TwinReport::NumWithin(const std::string& twin) const {
  return static_cast<int>(std::ranges::count_if(
      comparisons, [&](const TwinComparison& c) { return c.twin == twin && c.IsWithin(); }));
}

TwinReport MakeTwinReport(const TwinSource& source, const MotionEstimator& estimator,
                          const std::string& folder, double assumed_sigma_px, std::uint64_t seed,
                          int num_twins) {
  TwinReport report;
  report.scene = source.scene;
  report.num_pairs = static_cast<int>(source.pairs.size());
  report.fit = FitTwin(source, estimator, seed);
  report.semi_real = SemiRealData(report.fit, folder, assumed_sigma_px);
  std::vector<ComparedPair> pairs = ObservedOf(source, estimator, seed);
  const Redraw redraw(report.fit.noise);
  for (size_t i = 0; i < pairs.size(); ++i) {
    if (!source.pairs[i].exact) continue;
    for (int k = 1; k <= num_twins; ++k) {
      if (IsStopRequested()) throw Stopped("stopped; nothing more is written");
      const StreamName name{seed, StreamKeyOf(source.pairs[i].pair.origin),
                            static_cast<std::uint32_t>(k) * kCallsOfOne, 0};
      pairs[i].twins =
          Joined(pairs[i].twins, TwinValues(redraw.Draw(*source.pairs[i].exact, name), estimator, name));
    }
  }
  AddComparisons(pairs, "semi_real", &report);
  try {
    report.simulated = SimulatedTwinData(report.fit, assumed_sigma_px);
    const std::shared_ptr<const SimulatedData> data = MakeSimulatedData(report.simulated);
    for (size_t i = 0; i < pairs.size(); ++i) {
      pairs[i].twins = Values();
      for (int k = 1; k <= num_twins; ++k) {
        if (IsStopRequested()) throw Stopped("stopped; nothing more is written");
        const StreamName name{
            seed, StreamKeyOf(source.scene),
            (static_cast<std::uint32_t>(i) * 1000 + static_cast<std::uint32_t>(k)) * kCallsOfOne, 0};
        pairs[i].twins = Joined(pairs[i].twins, TwinValues(data->Make(name), estimator, name));
      }
    }
    AddComparisons(pairs, "simulated", &report);
  } catch (const InputError& error) {
    report.simulated.clear();
    report.why_not_simulated = error.what();
  }
  return report;
}

std::string TwinsAsText(const std::vector<TwinReport>& reports) {
  std::string text;
  for (const TwinReport& report : reports) text += ReportAsText(report);
  text +=
      "semi-real: the key points of the pairs, put where the estimated geometry has them, with noise drawn "
      "anew and "
      "wrong\nmatches dealt out again; simulated: a scene of the simulator fitted to the numbers above. "
      "Observed "
      "intervals hold for all\nquantities of a scene together and respect images that pairs share. "
      "Quantities:\n";
  for (const QuantityText& quantity : kTexts)
    text += fmt::format("  {:<18}{}\n", quantity.name, quantity.words);
  return text;
}

std::string TwinsAsCsv(const std::vector<TwinReport>& reports) {
  std::string text = "scene,pairs,twin,quantity,kind,observed,lower,upper,n,predicted,within\n";
  for (const TwinReport& report : reports) {
    for (const TwinComparison& c : report.comparisons) {
      text += fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", CsvField(report.scene), report.num_pairs,
                          c.twin, c.quantity, c.is_rate ? "rate" : "mean", CsvNumber(c.observed),
                          CsvFinite(c.joint.lower), CsvFinite(c.joint.upper), c.n, CsvNumber(c.predicted),
                          c.IsWithin() ? "yes" : "no");
    }
  }
  return text;
}

}  // namespace rcme
