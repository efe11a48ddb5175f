#include "stats/pooled_scores.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <vector>

#include "stats/constants.h"
#include "stats/distributions.h"
#include "stats/eigen_solvers.h"

namespace rcme {
namespace {

// Least information, in units in which every parameter alone has 1; below it a combination is not determined.
constexpr double kLeastInformation = 1e-9;
constexpr double kCommonDegreesOfFreedom = 10.0;  // nu_0, at most
constexpr PooledParameter kUndetermined = {kNaN, kNaN, {-kInfinity, kInfinity}, 0.0};

// Scales symmetric matrices such that the total information has a unit diagonal.
struct Scaling {
  Eigen::VectorXd scale;
  explicit Scaling(const Eigen::MatrixXd& all) : scale(all.diagonal().cwiseSqrt().cwiseInverse()) {}
  Eigen::MatrixXd Of(const Eigen::MatrixXd& matrix) const {
    return scale.asDiagonal() * matrix * scale.asDiagonal();
  }
};

// nullopt for a singular matrix.
std::optional<Eigen::MatrixXd> Invert(const Eigen::MatrixXd& information, const Scaling& scaling) {
  const Eigen::MatrixXd scaled = scaling.Of(information);
  if (!scaled.allFinite()) return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  if (!(eigen.eigenvalues()(0) > kLeastInformation)) return std::nullopt;
  return scaling.Of(eigen.eigenvectors() * eigen.eigenvalues().cwiseInverse().asDiagonal() *
                    eigen.eigenvectors().transpose());
}

// The sum of squares, about their mean, of the moves of one parameter when parts of the units are left out.
double SumSquares(const std::vector<double>& moves) {
  const double mean = std::accumulate(moves.begin(), moves.end(), 0.0) / static_cast<double>(moves.size());
  double squares = 0.0;
  for (const double move : moves) squares += (move - mean) * (move - mean);
  return squares;
}

// Sums over the units that have a member.
struct MemberSum {
  Eigen::VectorXd rest;         // sum s_u - A_u theta
  Eigen::MatrixXd information;  // sum A_u
};
using MemberSums = std::map<std::int64_t, MemberSum>;

void AddToMember(std::int64_t member, const Eigen::VectorXd& rest, const Eigen::MatrixXd& information,
                 MemberSums* sums) {
  const MemberSum nothing = {Eigen::VectorXd::Zero(rest.size()),
                             Eigen::MatrixXd::Zero(rest.size(), rest.size())};
  MemberSum& sum = sums->try_emplace(member, nothing).first->second;
  sum.rest += rest;
  sum.information += information;
}

// The scatter of units, and of the units of each member, about the pooled estimate.
struct Scatter {
  std::vector<std::vector<double>> of_units, of_members;  // d_u and d_i of each parameter
  std::vector<bool> has_two_members;                      // per unit
  double squares = 0.0, squared_shares = 0.0;             // sum e_u' A^-1 e_u; S
  Eigen::VectorXd squared_shares_of_each;                 // sum h_u^2
};

// Adds (A - left_out)^-1 rest; false if the rest does not determine a parameter.
bool AddMove(const Eigen::MatrixXd& A, const Eigen::MatrixXd& left_out, const Eigen::VectorXd& rest,
             const Scaling& scaling, std::vector<std::vector<double>>* moves) {
  const std::optional<Eigen::MatrixXd> others = Invert(A - left_out, scaling);
  if (!others) return false;
  const Eigen::VectorXd move = *others * rest;
  for (Eigen::Index j = 0; j < rest.size(); ++j) (*moves)[static_cast<size_t>(j)].push_back(move(j));
  return true;
}

// nullopt if a unit or a member alone determines a parameter.
std::optional<Scatter> ComputeScatter(std::span<const UnitScore> units, const Eigen::MatrixXd& A,
                                      const Eigen::MatrixXd& inverse, const Eigen::VectorXd& theta,
                                      const Scaling& scaling) {
  const auto k = static_cast<size_t>(theta.size());
  Scatter scatter;
  scatter.of_units.resize(k);
  scatter.of_members.resize(k);
  scatter.squared_shares_of_each = Eigen::VectorXd::Zero(theta.size());
  MemberSums members;
  for (const UnitScore& unit : units) {
    const Eigen::MatrixXd share = inverse * unit.information;
    scatter.squared_shares_of_each += share.diagonal().cwiseAbs2();
    scatter.squared_shares += (share * share).trace();
    const Eigen::VectorXd rest = unit.score - unit.information * theta;
    scatter.squares += rest.dot(inverse * rest);
    if (!AddMove(A, unit.information, rest, scaling, &scatter.of_units)) return std::nullopt;
    scatter.has_two_members.push_back(unit.member1 != unit.member2);
    AddToMember(unit.member1, rest, unit.information, &members);
    if (unit.member1 != unit.member2) AddToMember(unit.member2, rest, unit.information, &members);
  }
  for (const auto& [member, sum] : members)
    if (!AddMove(A, sum.information, sum.rest, scaling, &scatter.of_members)) return std::nullopt;
  if (!(scatter.squared_shares < static_cast<double>(theta.size()))) return std::nullopt;
  return scatter;
}

// The jackknife estimates of one parameter's variance.
struct Jackknife {
  double variance = 0.0, variance_if_apart = 0.0;
};
Jackknife ComputeJackknife(const Scatter& scatter, size_t j) {
  const std::vector<double>&of_units = scatter.of_units[j], &of_members = scatter.of_members[j];
  std::vector<double> twice;  // of the units that occur in two members' sums
  for (size_t u = 0; u < of_units.size(); ++u)
    if (scatter.has_two_members[u]) twice.push_back(of_units[u]);
  const auto n = static_cast<double>(of_units.size()), num_members = static_cast<double>(of_members.size());
  const double apart = n / (n - 1.0) * SumSquares(of_units);
  const double shared = SumSquares(of_members) - (twice.empty() ? 0.0 : SumSquares(twice));
  return {std::max(apart, num_members / (num_members - 1.0) * shared), apart};
}

double RatioOrOne(double x, double y) { return y > 0.0 ? x / y : 1.0; }

// Rounds degrees of freedom that are integers up to rounding error.
int Whole(double x) { return static_cast<int>(std::max(1.0, x + 1e-6)); }

}  // namespace

PooledScores PoolScores(std::span<const UnitScore> units, double confidence) {
  PooledScores pooled{{}, kNaN, kNaN, {}};
  if (units.empty()) return pooled;
  const Eigen::Index k = units.front().score.size();
  pooled.parameters.assign(static_cast<size_t>(k), kUndetermined);
  Eigen::VectorXd score = Eigen::VectorXd::Zero(k);
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(k, k);
  for (const UnitScore& unit : units) score += unit.score, A += unit.information;
  const Scaling scaling(A);
  const std::optional<Eigen::MatrixXd> inverse = Invert(A, scaling);
  if (!inverse) return pooled;
  const Eigen::VectorXd theta = *inverse * score;
  const Eigen::VectorXd one_over_sd = inverse->diagonal().cwiseSqrt().cwiseInverse();
  pooled.correlations = one_over_sd.asDiagonal() * *inverse * one_over_sd.asDiagonal();

  for (Eigen::Index j = 0; j < k; ++j) pooled.parameters[static_cast<size_t>(j)].value = theta(j);
  const std::optional<Scatter> scatter = ComputeScatter(units, A, *inverse, theta, scaling);
  if (!scatter) return pooled;

  const double parameters = static_cast<double>(k), of_shares = scatter->squared_shares;
  pooled.dispersion = scatter->squares / (parameters - of_shares);
  std::vector<Jackknife> jackknives;
  double sharing = 0.0;  // c
  for (size_t j = 0; j < pooled.parameters.size(); ++j) {
    jackknives.push_back(ComputeJackknife(*scatter, j));
    sharing += RatioOrOne(jackknives.back().variance, jackknives.back().variance_if_apart) / parameters;
  }
  const double n = static_cast<double>(units.size());
  const auto num_members = static_cast<double>(scatter->of_members.front().size());
  const double common = std::min(kCommonDegreesOfFreedom, n - 1.0);
  for (Eigen::Index j = 0; j < k; ++j) {
    PooledParameter& parameter = pooled.parameters[static_cast<size_t>(j)];
    const Jackknife& own = jackknives[static_cast<size_t>(j)];
    parameter.effective_n = 1.0 / scatter->squared_shares_of_each(j);
    const double fewest = std::min({n, num_members, parameter.effective_n});
    const double of_own = std::max(1.0, fewest - 1.0);
    const double moderated =
        (common * pooled.dispersion * sharing * (*inverse)(j, j) + of_own * own.variance) / (common + of_own);
    parameter.standard_error = std::sqrt(moderated);
    const double half =
        parameter.standard_error * StudentQuantile(Whole(common + of_own), 0.5 * (1.0 + confidence));
    parameter.interval = {parameter.value - half, parameter.value + half};
  }
  if (pooled.dispersion > 0.0) {
    const double F = theta.dot(A * theta) / (parameters * pooled.dispersion * sharing);
    pooled.p_value =
        1.0 - FisherCdf(static_cast<int>(k), Whole((parameters - of_shares) * parameters / of_shares), F);
  }
  return pooled;
}

PooledParameter PoolScoreAlone(std::span<const UnitScore> units, Eigen::Index j, double confidence) {
  std::vector<UnitScore> alone;
  for (const UnitScore& unit : units) {
    alone.push_back(
        {unit.member1, unit.member2, unit.score.segment(j, 1), unit.information.block(j, j, 1, 1)});
  }
  const PooledScores pooled = PoolScores(alone, confidence);
  return pooled.parameters.empty() ? kUndetermined : pooled.parameters.front();
}

}  // namespace rcme
