"""Fits the constants of rcme_calibrated; see scripts/fit_calibrated.

In two passes, as the check sees the modes as they are weighed: first the weights of the modes (--modes), then, with the program built
anew, the check.

Training: draws of studies/right_calibration.yaml and of studies/any_condition.yaml, and the families of studies/calibrated, with seeds
of their own; the latter two count less. Where partners are permuted at random every answer is wrong. The covariance is fitted where the calibration is right: errors of the calibration are not for
residuals to tell. Reported on draws with other seeds. Each trial's terms come from the program rcme_calibrated_terms, the measures of the
report with their intervals from rcme_calibrated_measures; regimes are told apart by what was simulated, which the fit does not see.
"""

import argparse
import csv
import pathlib
import re
import subprocess
import sys

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
HEADER = ROOT / "estimator/calibrated/fitted_constants.h"
FAMILIES = ["indoor", "outdoor", "low_parallax", "planarity", "moving_object", "hard", "few_matches", "noise_laws", "outlier_laws",
            "uniform", "forward", "parallax", "clustered_inliers", "assumed_sigma"]
LESS = 0.3  # weight of a trial with a wrong calibration, or of a family, which are easy and many
MODES_OF_FAMILY = 2.0  # the same where the modes' weights are fitted: there the families have few trials with two modes
RIDGE = 5e-4  # of the standardised terms' weights, per trial
OUTSIDE = 0.005  # share of the training trials beyond either end of a term's domain
QUANTILE_95 = 11.0705  # of chi-square with five degrees of freedom
SURE = 0.05  # the covariance is fitted where the probability of failure is at most this
LOG_ODDS, SLOPE = "failure_posterior_log_odds", "failure_log_odds_by_"  # the posterior's, and terms that are it times something
LEAST_SLOPE = 0.02  # of the log-odds (kLeastSlope of checked_probability.cc)
DEPENDENT_NOISE = {"correlated", "duplicated", "anisotropic"}
OF_ALL = {"ECE", "AUC", "Brier"}  # measures that are reported of all regimes together
COHERENT_OUTLIERS = {"moving_object", "clustered_both", "repeated_texture", "mixture"}


class Source:
    """Trials of a study: `number` draws of its population (None: its own conditions), `trials` of each."""

    def __init__(self, study, seed, number, trials, weight=1.0, fits_covariance=True, listing="check"):
        self.study, self.seed, self.number, self.trials = study, seed, number, trials
        self.weight, self.fits_covariance, self.listing = weight, fits_covariance, listing

    def name(self):
        return f"{self.listing}_{pathlib.Path(self.study).stem}_{self.seed}_{self.number}_{self.trials}"

    def population(self):
        return pathlib.Path(self.study).stem + (" with partners permuted" if self.listing == "permuted" else "")


def sources_of_modes(scale):
    """(training, held out) of the weights of the modes; errors of the calibration are not theirs to tell."""
    draws = lambda n: max(20, int(n * scale))
    training = [Source("studies/right_calibration.yaml", 71, draws(2000), 4, listing="modes")]
    training += [Source(f"studies/calibrated/{family}.yaml", 73, None, max(2, int(20 * scale)), MODES_OF_FAMILY, listing="modes")
                 for family in ("indoor", "outdoor", "planarity", "hard", "few_matches")]
    return training, [Source("studies/right_calibration.yaml", 81, draws(800), 4, listing="modes")]


def sources(scale):
    """(training, held out) of the check; `scale` 1 for the committed constants."""
    draws = lambda n: max(20, int(n * scale))
    training = [Source("studies/right_calibration.yaml", 51, draws(2400), 4), Source("studies/any_condition.yaml", 52, draws(600), 4, LESS, fits_covariance=False)]
    training += [Source(f"studies/calibrated/{family}.yaml", 53, None, max(2, int(20 * scale)), LESS) for family in FAMILIES]
    training.append(Source("studies/right_calibration.yaml", 54, draws(300), 4, LESS, fits_covariance=False, listing="permuted"))
    held_out = [Source("studies/right_calibration.yaml", 61, draws(400), 12), Source("studies/any_condition.yaml", 62, draws(200), 12),
                Source("studies/right_calibration.yaml", 64, draws(100), 6, listing="permuted")]
    return training, held_out


def make_trials(source, programs, folder, keeps):
    """The CSV of a source's trials; one that is there is taken as it is if `keeps`."""
    made = folder / f"{source.name()}.csv"
    if keeps and made.exists():
        return made
    text = (ROOT / source.study).read_text()
    if source.number is not None:
        text = re.sub(r"number: \d+", f"number: {source.number}", text)
    text = re.sub(r"(?m)^    (# All motions.*|motion:.*(\n      .*)+)\n", "", text)  # those of the population: see PrintTrial
    text = re.sub(r"population: (\w+)", rf"population: {ROOT}/populations/\1.yaml", text)
    text = re.sub(r"(?m)^estimators:\n(  .*\n)+", "estimators:\n  - {name: rcme_calibrated}\n", text)
    study = folder / f"{source.name()}.yaml"
    study.write_text(text)
    with open(made.with_suffix(".part"), "w") as out:
        subprocess.run([programs / "rcme_calibrated_terms", source.listing, study, str(source.seed), str(source.trials)], stdout=out, check=True)
    made.with_suffix(".part").rename(made)
    return made


class ModePairs:
    """Rows of the sources as arrays: terms of a right mode against a wrong one, weight."""

    def __init__(self, files, sources):
        rows = [(row, source.weight) for path, source in zip(files, sources) for row in csv.DictReader(open(path, newline=""))]
        self.names = [key for key in rows[0][0] if key.startswith("mode_")]
        self.x = np.array([[float(row[key]) for key in self.names] for row, _ in rows])
        self.weight = np.array([weight * float(row["share"]) for row, weight in rows])

    def log_loss(self, b):
        return np.average(np.logaddexp(0, -(self.x @ b)), weights=self.weight)

    def wrong(self, b):
        """Share of the trials' weight in which the wrong mode is the likelier one."""
        return np.average(self.x @ b <= 0, weights=self.weight)


class Trials:
    """Rows of the sources as arrays: failure and spread terms, posterior, outcome, cluster, regime."""

    def __init__(self, files, sources):
        rows, self.weight, self.cluster, self.fits_covariance, self.is_permuted = [], [], [], [], []
        for k, (path, source) in enumerate(zip(files, sources)):
            with open(path, newline="") as file:
                for row in csv.DictReader(file):
                    rows.append(row)
                    self.weight.append(source.weight)
                    self.fits_covariance.append(source.fits_covariance)
                    self.is_permuted.append(source.listing == "permuted")
                    self.cluster.append((k, row["condition"]))
        self.names = [key for key in rows[0] if key.startswith("failure_")]
        self.spread_names = [key for key in rows[0] if key.startswith("spread_")]
        column = lambda key: np.array([float(row[key]) for row in rows])
        self.x = np.column_stack([column(key) for key in self.names])
        self.spread = np.column_stack([column(key) for key in self.spread_names])
        self.posterior, self.nees, self.failed = column("posterior"), column("nees"), column("failed")
        self.weight, self.fits_covariance, self.is_permuted = (np.array(x) for x in (self.weight, self.fits_covariance, self.is_permuted))
        _, self.cluster = np.unique([f"{k}:{c}" for k, c in self.cluster], return_inverse=True)
        self.regime = np.array([self._regime(row) for row in rows])

    @staticmethod
    def _regime(row):
        dependent = row.get("noise") in DEPENDENT_NOISE
        coherent = row.get("outliers") in COHERENT_OUTLIERS
        if dependent and coherent:
            return "both"
        if dependent:
            return "dependent noise"
        if coherent:
            return "coherent outliers"
        return "flat" if float(row["homography_share"]) > 0.9 else "deep"


def logistic(x):
    return 1.0 / (1.0 + np.exp(-np.clip(x, -40, 40)))


def probability(names, x, b):
    """P of the terms of these names, as CheckedFailureProbability has it."""
    of_log_odds, slopes = names.index(LOG_ODDS), np.array([name.startswith(SLOPE) for name in names])
    log_odds = x[:, of_log_odds]
    slope = b[of_log_odds] + np.divide(x[:, slopes] @ b[slopes], log_odds, out=np.zeros(len(x)), where=log_odds != 0)
    rest = ~slopes
    rest[of_log_odds] = False
    return logistic(np.maximum(slope, LEAST_SLOPE) * log_odds + x[:, rest] @ b[rest])


def fit_failure(x, failed, weight, has_constant=True):
    """Weights of a ridge logistic regression by Newton's method; where there is a constant it is the first column."""
    scale = np.sqrt((x**2).mean(axis=0)) if not has_constant else x.std(axis=0)
    if has_constant:
        scale[0] = 1.0
    z = x / scale
    penalty = RIDGE * np.diag([0.0 if has_constant else 1.0] + [1.0] * (x.shape[1] - 1)) * weight.sum()
    b = np.zeros(x.shape[1])
    for _ in range(50):
        p = logistic(z @ b)
        hessian = (z * (weight * np.maximum(p * (1 - p), 1e-6))[:, None]).T @ z + penalty
        step = np.linalg.solve(hessian, z.T @ (weight * (failed - p)) - penalty @ b)
        b += step
        if np.abs(step).max() < 1e-8:
            break
    return b / scale


def fit_spread(y, nees, weight, level=0.95):
    """Weights of the regression of the quantile of log(nees / its 0.95 quantile), by reweighted least squares."""
    target = np.log(nees / QUANTILE_95)
    a = np.zeros(y.shape[1])
    a[0] = np.quantile(target, level)
    for _ in range(200):
        rest = target - y @ a
        w = weight * np.where(rest > 0, level, 1 - level) / np.maximum(np.abs(rest), 0.02)
        a = np.linalg.solve((y * w[:, None]).T @ y + 1e-9 * np.eye(y.shape[1]), (y * w[:, None]).T @ target)
    return a


def log_loss(p, failed, weight):
    p = np.clip(p, 1e-9, 1 - 1e-9)
    return -np.average(failed * np.log(p) + (1 - failed) * np.log(1 - p), weights=weight)


def in_domain(x, domain):
    """Whether all terms lie in the domain that the constants state (IsInDomain)."""
    return ((x >= domain[:, 0]) & (x <= domain[:, 1])).all(axis=1)


def measure(programs, trials, p, covered, here):
    """Rows (quantity, before, after) of chosen trials; `p` and `covered` are pairs (before, after)."""
    columns = [trials.cluster, trials.failed.astype(int), p[0], covered[0].astype(int), p[1], covered[1].astype(int)]
    text = "".join(f"{c} {failed} {p0:.17g} {c0} {p1:.17g} {c1}\n" for c, failed, p0, c0, p1, c1 in zip(*(x[here] for x in columns)))
    done = subprocess.run([programs / "rcme_calibrated_measures"], input=text, capture_output=True, text=True, check=True)
    return list(csv.reader(done.stdout.splitlines()))[1:]


def report(programs, source, trials, p, factor, is_verified):
    """Rows (population, regime, conditions, quantity, before, after); of random partners no regime of its own."""
    rows = []
    covered = trials.nees <= QUANTILE_95, trials.nees / factor <= QUANTILE_95
    regimes = [("all", np.ones(len(p), bool)), ("verified", is_verified), ("extrapolated", ~is_verified)]
    regimes += [(regime, trials.regime == regime) for regime in sorted(set(trials.regime))]
    for regime, here in regimes[:1] if source.listing == "permuted" else regimes:
        if not here.any():
            continue
        for row in measure(programs, trials, (trials.posterior, p), covered, here):
            if regime == "all" or row[0] not in OF_ALL:
                rows.append([source.population(), regime, len(np.unique(trials.cluster[here])), *row])
    return rows


def describe_sources(training):
    """Comment lines, one per source."""
    return "".join(f"//   {s.study}, seed {s.seed}, " + (f"{s.number} draws, " if s.number else "") + f"{s.trials} trials of each condition"
                   + (f", weight {s.weight}" if s.weight != 1 else "") + (", partners permuted" if s.listing == "permuted" else "") + ("" if s.fits_covariance else ", for P alone") + "\n" for s in training)


def write_constants(name, training, keys, weights, x):
    """Replaces an array of the header, and above it the trials that it was fitted to."""
    prefix = keys[0].split("_")[0] + "_"
    terms = "".join(f'    {{"{key[len(prefix):]}", {weight:.6g}, {least:.6g}, {most:.6g}}},\n'
                    for key, weight, least, most in zip(keys, weights, *np.quantile(x, [OUTSIDE, 1 - OUTSIDE], axis=0)))
    made = f"// Fitted to\n//\n{describe_sources(training)}inline constexpr FittedTerm {name}[] = {{\n{terms}}};\n"
    HEADER.write_text(re.sub(rf"// Fitted to\n(//[^\n]*\n)*inline constexpr FittedTerm {name}\[\] = {{\n(.*?)\n}};\n",
                             lambda _: made, HEADER.read_text(), flags=re.DOTALL))


def read_constants(name):
    """Rows (weight, least, most) of an array of the header, as they are in the program."""
    array = re.search(rf"{name}\[\] = {{\n(.*?)\n}};", HEADER.read_text(), re.DOTALL)[1]
    return np.array([[float(x) for x in row.rstrip("},").split(", ")[1:]] for row in array.splitlines()])


def read_header():
    """(b, its domain, a) of the check's constants as they are in the program."""
    failure, spread = read_constants("kFailureTerms"), read_constants("kSpreadTerms")
    return failure[:, 0], failure[:, 1:], spread[:, 0]


def is_same(now, fitted):
    return now.shape == fitted.shape and np.allclose(now, fitted, rtol=1e-4, atol=1e-6)


def write_tables(programs, folder, train, held_out, tests):
    b, domain, a = read_header()
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / "held_out.csv", "w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["population", "regime", "conditions", "quantity", "before", "after"])
        for source, test in zip(held_out, tests):
            factor = np.maximum(1.0, np.exp(test.spread @ a))
            p = probability(test.names, test.x, b)
            table.writerows(report(programs, source, test, p, factor, in_domain(test.x, domain)))
    with open(folder / "terms.csv", "w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["term", "weight", "log_loss_more_without"])
        base = log_loss(logistic(tests[0].x @ b), tests[0].failed, tests[0].weight)
        for k, name in enumerate(train.names):
            rest = [j for j in range(len(train.names)) if j != k]
            without = fit_failure(train.x[:, rest], train.failed, train.weight) if k else None
            cost = log_loss(logistic(tests[0].x[:, rest] @ without), tests[0].failed, tests[0].weight) - base if k else float("nan")
            table.writerow([name[len("failure_"):], f"{b[k]:.4g}", f"{cost:.4f}" if k else ""])
        for name, weight in zip(train.spread_names, a):
            table.writerow(["covariance: " + name[len("spread_"):], f"{weight:.4g}", ""])


def write_modes_table(folder, train, test, b):
    """What each term of the modes' weights costs when it is left out, on trials that were not fitted to."""
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / "modes.csv", "w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["term", "weight", "log_loss_more_without", "wrong_mode_more_without_percent"])
        for k, name in enumerate(train.names):
            without = b.copy()
            rest = [j for j in range(len(b)) if j != k]
            without[rest], without[k] = fit_failure(train.x[:, rest], np.ones(len(train.x)), train.weight, has_constant=False), 0.0
            table.writerow([name[len("mode_"):], f"{b[k]:.4g}", f"{test.log_loss(without) - test.log_loss(b):.4f}",
                            f"{100 * (test.wrong(without) - test.wrong(b)):.2f}"])
        table.writerow(["all", "", f"{test.log_loss(b):.4f}", f"{100 * test.wrong(b):.2f}"])


def fit_modes(arguments):
    training, held_out = sources_of_modes(arguments.scale)
    files = make_all(training + held_out, arguments)
    train = ModePairs(files[:len(training)], training)
    b = fit_failure(train.x, np.ones(len(train.x)), train.weight, has_constant=False)
    if not arguments.report_only:
        write_constants("kModeTerms", training, train.names, b, train.x)
    write_modes_table(arguments.out, train, ModePairs(files[len(training):], held_out), b)
    return is_same(read_constants("kModeTerms")[:, 0], b)


def fit_check(arguments):
    training, held_out = sources(arguments.scale)
    files = make_all(training + held_out, arguments)
    train = Trials(files[:len(training)], training)
    b = fit_failure(train.x, train.failed, train.weight)
    sure = train.fits_covariance & (probability(train.names, train.x, b) <= SURE) & np.isfinite(train.nees) & (train.nees > 0)
    a = fit_spread(train.spread[sure], train.nees[sure], train.weight[sure])
    if not arguments.report_only:
        # Random partners are no domain in which P could be verified.
        write_constants("kFailureTerms", training, train.names, b, train.x[~train.is_permuted])
        write_constants("kSpreadTerms", [s for s in training if s.fits_covariance], train.spread_names, a, train.spread[~train.is_permuted])
    tests = [Trials([path], [source]) for path, source in zip(files[len(training):], held_out)]
    write_tables(arguments.programs, arguments.out, train, held_out, tests)
    now_b, _, now_a = read_header()
    return is_same(now_b, b) and is_same(now_a, a)


def make_all(sources, arguments):
    files = []
    for source in sources:
        files.append(make_trials(source, arguments.programs, arguments.trials, arguments.resume))
        print(f"{len(files)} of {len(sources)} populations and families", file=sys.stderr)
    return files


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--modes", action="store_true", help="the weights of the modes, in place of the check")
    parser.add_argument("--programs", default=ROOT / "build/release/bin", type=pathlib.Path, help="folder of the two programs")
    parser.add_argument("--trials", default=ROOT / "build/fit_calibrated", type=pathlib.Path, help="folder of the trials")
    parser.add_argument("--resume", action="store_true", help="take trials that are there as they are")
    parser.add_argument("--out", default=ROOT / "results/right_calibration", type=pathlib.Path, help="folder of the tables")
    parser.add_argument("--scale", type=float, default=1.0, help="share of the trials, to try the script")
    parser.add_argument("--report-only", action="store_true", help="leave the constants as they are; exit code 1 if a fit gives others")
    arguments = parser.parse_args()
    arguments.trials.mkdir(parents=True, exist_ok=True)
    if not (fit_modes if arguments.modes else fit_check)(arguments):
        sys.exit("fit_calibrated: the constants of estimator/calibrated/fitted_constants.h are not those of this fit")


if __name__ == "__main__":
    main()
