"""Fits the constants of rcme_calibrated's check; see scripts/fit_calibrated.

Training: draws of studies/right_calibration.yaml and of studies/any_condition.yaml, and the families of studies/calibrated, with seeds
of their own; the latter two count less. The covariance is fitted where the calibration is right: errors of the calibration are not for
residuals to tell. Reported on draws with other seeds. Each trial's terms come from the program
rcme_calibrated_terms; regimes are told apart by what was simulated, which the fit does not see.
"""

import argparse
import concurrent.futures
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
RIDGE = 5e-4  # of the standardised terms' weights, per trial
NUM_SPREAD_TERMS = 3
OUTSIDE = 0.005  # share of the training trials beyond either end of a term's domain
QUANTILE_95 = 11.0705  # of chi-square with five degrees of freedom
SURE = 0.05  # the covariance is fitted where the probability of failure is at most this
SLOPES = slice(3, 8)  # the terms that are the posterior's log-odds times something
LEAST_SLOPE = 0.02  # of the log-odds (kLeastSlope of checked_probability.cc)
LEAST_CONDITIONS = 5  # for an interval over conditions
DEPENDENT_NOISE = {"correlated", "duplicated", "anisotropic"}
COHERENT_OUTLIERS = {"moving_object", "clustered_both", "repeated_texture", "mixture"}


class Source:
    """Trials of a study: `number` draws of its population (None: its own conditions), `trials` of each."""

    def __init__(self, study, seed, number, trials, weight=1.0, fits_covariance=True):
        self.study, self.seed, self.number, self.trials = study, seed, number, trials
        self.weight, self.fits_covariance = weight, fits_covariance

    def name(self):
        return f"{pathlib.Path(self.study).stem}_{self.seed}_{self.number}_{self.trials}"


def sources(scale):
    """(training, held out); `scale` 1 for the committed constants."""
    draws = lambda n: max(20, int(n * scale))
    training = [Source("studies/right_calibration.yaml", 51, draws(2400), 4), Source("studies/any_condition.yaml", 52, draws(600), 4, LESS, fits_covariance=False)]
    training += [Source(f"studies/calibrated/{family}.yaml", 53, None, max(2, int(20 * scale)), LESS) for family in FAMILIES]
    held_out = [Source("studies/right_calibration.yaml", 61, draws(400), 12), Source("studies/any_condition.yaml", 62, draws(200), 12)]
    return training, held_out


def make_trials(source, program, folder, keeps):
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
        subprocess.run([program, study, str(source.seed), str(source.trials)], stdout=out, check=True)
    made.with_suffix(".part").rename(made)
    return made


class Trials:
    """Rows of the sources as arrays: failure and spread terms, posterior, outcome, cluster, regime."""

    def __init__(self, files, sources):
        rows, self.weight, self.cluster, self.fits_covariance = [], [], [], []
        for k, (path, source) in enumerate(zip(files, sources)):
            with open(path, newline="") as file:
                for row in csv.DictReader(file):
                    rows.append(row)
                    self.weight.append(source.weight)
                    self.fits_covariance.append(source.fits_covariance)
                    self.cluster.append((k, row["condition"]))
        self.names = [key for key in rows[0] if key.startswith("failure_")]
        self.spread_names = [key for key in rows[0] if key.startswith("spread_")]
        column = lambda key: np.array([float(row[key]) for row in rows])
        self.x = np.column_stack([column(key) for key in self.names])
        self.spread = np.column_stack([column(key) for key in self.spread_names])
        self.posterior, self.nees, self.failed = column("posterior"), column("nees"), column("failed")
        self.weight, self.fits_covariance = np.array(self.weight), np.array(self.fits_covariance)
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


def probability(x, b):
    """P of the terms, as CheckedFailureProbability has it."""
    log_odds = x[:, 1]
    slope = b[1] + np.divide(x[:, SLOPES] @ b[SLOPES], log_odds, out=np.zeros(len(x)), where=log_odds != 0)
    rest = np.ones(x.shape[1], bool)
    rest[1], rest[SLOPES] = False, False
    return logistic(np.maximum(slope, LEAST_SLOPE) * log_odds + x[:, rest] @ b[rest])


def fit_failure(x, failed, weight):
    """Weights of a ridge logistic regression by Newton's method; the first column is the constant."""
    scale = x.std(axis=0)
    scale[0] = 1.0
    z = x / scale
    penalty = RIDGE * np.diag([0.0] + [1.0] * (x.shape[1] - 1)) * weight.sum()
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


def calibration_error(p, failed):
    """Expected calibration error, ten bins of equal width."""
    bins = np.minimum((10 * p).astype(int), 9)
    return sum(abs(p[bins == k].sum() - failed[bins == k].sum()) for k in range(10)) / len(p)


def area(p, failed):
    """Area under the ROC curve: the probability that a failure has the greater p, ties by half."""
    order = np.argsort(p, kind="stable")
    ranks = np.empty(len(p))
    ranks[order] = np.arange(1, len(p) + 1)
    for value in np.unique(p[np.concatenate([[False], np.diff(p[order]) == 0])[np.argsort(order)]]):
        ranks[p == value] = ranks[p == value].mean()
    n = failed.sum()
    return (ranks[failed == 1].sum() - n * (n + 1) / 2) / (n * (len(p) - n))


def bootstrap(trials, statistic, select, repetitions=400):
    """A statistic of chosen trials with its 95 % interval, conditions being the sample. Where every condition gives 0 or every
    one 1, the interval ends 3 / (number of conditions) away (P(none of m) = .05); "-" for fewer than five conditions."""
    chosen = np.flatnonzero(select)
    clusters, places = np.unique(trials.cluster[chosen], return_inverse=True)
    if len(clusters) < LEAST_CONDITIONS:
        return "-"
    random = np.random.default_rng(1)
    members = [chosen[places == k] for k in range(len(clusters))]
    values = []
    for _ in range(repetitions):
        picked = np.concatenate([members[k] for k in random.integers(0, len(clusters), len(clusters))])
        values.append(statistic(picked))
    low, high = np.nanquantile(values, [0.025, 0.975])
    value, away = statistic(chosen), 3 / len(clusters)
    low, high = (low, min(1, away)) if high == value == 0 else (max(0, 1 - away), high) if low == value == 1 else (low, high)
    return f"{value:.3f} [{low:.3f}, {high:.3f}]"


def in_domain(x, domain):
    """Whether all terms lie in the domain that the constants state (IsInDomain)."""
    return ((x >= domain[:, 0]) & (x <= domain[:, 1])).all(axis=1)


def report(title, trials, p, factor, is_verified):
    """Rows (population, regime, conditions, quantity, before, after)."""
    rows = []
    covered = trials.nees <= QUANTILE_95, trials.nees / factor <= QUANTILE_95
    mean = lambda of: lambda i: of[i].mean() if len(i) else float("nan")
    everything = np.ones(len(p), bool)
    both = [("before", trials.posterior, covered[0]), ("after", p, covered[1])]
    regimes = [("all", everything), ("verified", is_verified), ("extrapolated", ~is_verified)]
    regimes += [(regime, trials.regime == regime) for regime in sorted(set(trials.regime))]
    for regime, here in regimes:
        def add(quantity, values):
            rows.append([title, regime, len(np.unique(trials.cluster[here])), quantity, *values])
        add("failed", [bootstrap(trials, mean(trials.failed), here)] * 2)
        add("stated", [bootstrap(trials, mean(q), here) for _, q, _ in both])
        add("kept at P <= 0.1", [bootstrap(trials, lambda i, q=q: (q[i] <= 0.1).mean(), here) for _, q, _ in both])
        add("failed at P <= 0.1", [bootstrap(trials, mean(trials.failed), here & (q <= 0.1)) for _, q, _ in both])
        add("covered at P <= 0.1", [bootstrap(trials, mean(c.astype(float)), here & (q <= 0.1)) for _, q, c in both])
        add("covered at P <= 0.01", [bootstrap(trials, mean(c.astype(float)), here & (q <= 0.01)) for _, q, c in both])
        if regime == "all":
            add("ECE", [bootstrap(trials, lambda i, q=q: calibration_error(q[i], trials.failed[i]), here) for _, q, _ in both])
            add("AUC", [bootstrap(trials, lambda i, q=q: area(q[i], trials.failed[i]), here, 100) for _, q, _ in both])
            add("Brier", [bootstrap(trials, lambda i, q=q: ((q[i] - trials.failed[i]) ** 2).mean(), here) for _, q, _ in both])
    return rows


def write_header(training, train, b, a):
    said = "\n".join(f"//   {s.study}, seed {s.seed}, " + (f"{s.number} draws, " if s.number else "") + f"{s.trials} trials of each condition"
                     + (f", weight {s.weight}" if s.weight != 1 else "")
                     + ("" if s.fits_covariance else ", for P alone") for s in training)
    terms = lambda keys, prefix, weights, x: "".join(
        f'    {{"{key[len(prefix):]}", {weight:.6g}, {least:.6g}, {most:.6g}}},\n'
        for key, weight, least, most in zip(keys, weights, *np.quantile(x, [OUTSIDE, 1 - OUTSIDE], axis=0)))
    HEADER.write_text(
        "// Constants of the check of rcme_calibrated's model (checked_probability.h), made by scripts/fit_calibrated from\n//\n"
        f"{said}\n//\n"
        "#pragma once\n\nnamespace rcme {\n\nstruct FittedTerm {\n  const char* name;\n  double weight;\n  double least, most;  // of the trials, but for half a per cent on either side\n};\n\n"
        "inline constexpr FittedTerm kFailureTerms[] = {\n" + terms(train.names, "failure_", b, train.x) + "};\n\n"
        "inline constexpr FittedTerm kSpreadTerms[] = {\n" + terms(train.spread_names, "spread_", a, train.spread) + "};\n\n}  // namespace rcme\n")


def read_header():
    """(b, its domain, a) of the constants as they are in the program."""
    rows = re.findall(r'\{"(\w+)", ([-\d.e+]+), ([-\d.e+]+), ([-\d.e+]+)\}', HEADER.read_text())
    values = np.array([[float(x) for x in row[1:]] for row in rows])
    return values[:-NUM_SPREAD_TERMS, 0], values[:-NUM_SPREAD_TERMS, 1:], values[-NUM_SPREAD_TERMS:, 0]


def write_tables(folder, train, held_out, tests):
    b, domain, a = read_header()
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / "held_out.csv", "w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["population", "regime", "conditions", "quantity", "before", "after"])
        for source, test in zip(held_out, tests):
            factor = np.maximum(1.0, np.exp(test.spread @ a))
            table.writerows(report(pathlib.Path(source.study).stem, test, probability(test.x, b), factor, in_domain(test.x, domain)))
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


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default=ROOT / "build/release/bin/rcme_calibrated_terms", help="the program that makes the trials")
    parser.add_argument("--trials", default=ROOT / "build/fit_calibrated", type=pathlib.Path, help="folder of the trials")
    parser.add_argument("--resume", action="store_true", help="take trials that are there as they are")
    parser.add_argument("--out", default=ROOT / "results/right_calibration", type=pathlib.Path, help="folder of the tables")
    parser.add_argument("--scale", type=float, default=1.0, help="share of the trials, to try the script")
    parser.add_argument("--report-only", action="store_true", help="leave the constants as they are; exit code 1 if a fit gives others")
    arguments = parser.parse_args()
    arguments.trials.mkdir(parents=True, exist_ok=True)
    training, held_out = sources(arguments.scale)
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        futures = [pool.submit(make_trials, source, arguments.program, arguments.trials, arguments.resume) for source in training + held_out]
        for k, future in enumerate(futures, 1):
            future.result()
            print(f"{k} of {len(futures)} populations and families", file=sys.stderr)
    files = [future.result() for future in futures]
    train = Trials(files[:len(training)], training)
    b = fit_failure(train.x, train.failed, train.weight)
    sure = train.fits_covariance & (probability(train.x, b) <= SURE) & np.isfinite(train.nees) & (train.nees > 0)
    a = fit_spread(train.spread[sure], train.nees[sure], train.weight[sure])
    if not arguments.report_only:
        write_header(training, train, b, a)
    tests = [Trials([path], [source]) for path, source in zip(files[len(training):], held_out)]
    write_tables(arguments.out, train, held_out, tests)
    now_b, _, now_a = read_header()
    if not np.allclose(now_b, b, rtol=1e-4, atol=1e-6) or not np.allclose(now_a, a, rtol=1e-4, atol=1e-6):
        sys.exit("fit_calibrated: the constants of estimator/calibrated/fitted_constants.h are not those of this fit")


if __name__ == "__main__":
    main()
