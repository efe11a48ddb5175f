#include "experiments/audit/claims/claim_verdict.h"

#include <algorithm>
#include <map>

#include "experiments/core/text/pick_name.h"

namespace rcme {

const char* Name(ClaimVerdict verdict) {
  return PickName(verdict,
                  {Name(Verdict::kHolds), "holds in the small-noise limit only", Name(Verdict::kDoesNotHold),
                   Name(Verdict::kUndecided), "measured", "not possible"});
}

const char* Name(Side side) { return PickName(side, {"too narrow", "too wide", "too narrow and too wide"}); }

std::optional<Side> FindFailedSide(const Target& target, const TargetResult& result) {
  if (!target.IsOfRegion() || result.verdict != Verdict::kDoesNotHold) return std::nullopt;
  // A region that is too narrow covers too rarely, and its mean PIT is too great.
  const bool is_below = result.interval.upper < target.allowed.lower;
  return is_below == (target.kind == Target::Kind::kCoverage) ? Side::kTooNarrow : Side::kTooWide;
}

std::optional<Side> JoinSides(const std::vector<std::optional<Side>>& sides) {
  std::optional<Side> joined;
  for (const std::optional<Side>& side : sides) {
    if (side) joined = !joined || joined == side ? side : Side::kBoth;
  }
  return joined;
}

std::optional<Verdict> Together(const std::vector<std::optional<Verdict>>& verdicts) {
  std::optional<Verdict> all;
  for (const std::optional<Verdict>& verdict : verdicts) {
    if (!verdict) continue;
    if (*verdict == Verdict::kDoesNotHold) return Verdict::kDoesNotHold;
    if (!all || *verdict == Verdict::kUndecided) all = verdict;
  }
  return all;
}

void JudgeClaim(const Claim& claim, ClaimResult* result) {
  std::map<double, std::vector<std::optional<Verdict>>> verdicts_by_sigma;
  for (size_t i = 0; i < claim.checks.size(); ++i) {
    verdicts_by_sigma[claim.checks[i].sigma_px.value_or(kAssertedSigmaPx)].push_back(
        result->checks[i].verdict);
  }
  std::vector<std::pair<double, Verdict>> noise_levels;  // rising
  for (const auto& [sigma_px, verdicts] : verdicts_by_sigma) {
    if (const std::optional<Verdict> verdict = Together(verdicts))
      noise_levels.emplace_back(sigma_px, *verdict);
  }
  result->holds_up_to_sigma_px.reset();
  const bool is_possible = std::ranges::any_of(
      result->checks, [](const CheckResult& check) { return check.not_possible.empty(); });
  result->verdict = is_possible ? ClaimVerdict::kMeasured : ClaimVerdict::kNotPossible;
  if (noise_levels.empty()) return;

  const bool has_noise_levels = claim.checks.front().sigma_px.has_value();
  for (const auto& [sigma_px, verdict] : noise_levels) {
    if (verdict != Verdict::kHolds || !has_noise_levels) break;
    result->holds_up_to_sigma_px = sigma_px;
  }
  bool fails = false, is_undecided = false;  // at any noise level up to the asserted one
  for (const auto& [sigma_px, verdict] : noise_levels) {
    if (sigma_px > kAssertedSigmaPx && sigma_px > noise_levels.front().first) continue;
    fails |= verdict == Verdict::kDoesNotHold;
    is_undecided |= verdict == Verdict::kUndecided;
  }
  if (noise_levels.front().second == Verdict::kDoesNotHold) {
    result->verdict = ClaimVerdict::kDoesNotHold;
  } else if (noise_levels.front().second == Verdict::kUndecided || (!fails && is_undecided)) {
    result->verdict = ClaimVerdict::kUndecided;
  } else {
    result->verdict = fails ? ClaimVerdict::kSmallNoiseOnly : ClaimVerdict::kHolds;
  }
}

}  // namespace rcme
