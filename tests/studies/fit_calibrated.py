"""Fits the constants of rcme_calibrated; see scripts/fit_calibrated.

In two passes, as the check sees the modes as they are weighed: first the weights of the modes (--modes), then, with the program built
anew, the check.

The check's probability is a logistic regression on products of at most two hinges of its signs, which are chosen forward, one after the
other (Friedman 1991), each where it adds most to the likelihood by its score. Their number and the ridge were chosen in five-fold
cross-validation over the conditions of the training, which --cross-validate makes again (cross_validation.csv in the folder of the tables).
Signs are cut to the range that they had in nearly all trials.

Training: draws of studies/right_calibration.yaml and of studies/any_condition.yaml, and the families of studies/calibrated, with seeds
of their own; trials of the families count less. Where partners are permuted at random every answer is wrong. The covariance is fitted where the calibration is right: errors of the calibration are not for
residuals to tell. Reported on draws with other seeds. Each trial's terms come from the program rcme_calibrated_terms, the measures of the
report with their intervals from rcme_calibrated_measures; regimes are told apart by what was simulated, which the fit does not see.
"""

import argparse
import collections
import copy
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
OF_FAMILY, OF_RANDOM = 0.6, 0.3  # weights of a trial of a family, of one with random partners; they are easy and many
MODES_OF_FAMILY = 2.0  # the same where the modes' weights are fitted: there the families have few trials with two modes
PRIOR_TERMS, PRIOR_SHARE = ("mode_forward", "mode_axial", "mode_turn"), 0.6  # share of the fitted weights (mode_weights.h)
Form = collections.namedtuple("Form", "products ridge")  # of the check; the ridge is of the standardised terms' weights, per trial
FORM, TRIED_FORMS = Form(60, 4e-3), [Form(36, 4e-3), Form(48, 4e-3), Form(60, 4e-3)]
RIDGE_OF_MODES = 5e-4
FOLDS = 5
OUTSIDE = 0.005  # share of the training trials beyond either end of a term's domain
QUANTILE_95 = 11.0705  # of chi-square with five degrees of freedom
SURE = 0.05  # the covariance is fitted where the probability of failure is at most this
LEAST_SLOPE, MOST_LOG_ODDS = 0.02, 11.5  # of the posterior (kLeastSlope and kMostLogOdds of checked_probability.cc)
KNOTS = (0.1, 0.25, 0.5, 0.75, 0.9)  # quantiles of a sign
BEST_BY_CURVATURE = 25  # products whose score is computed beside all that are chosen
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
    return training, [Source("studies/right_calibration.yaml", 82, draws(800), 4, listing="modes")]


def sources_of_second_motions(scale):
    """(training, held out) of the weights of two motions, the camera's and an object's."""
    draws = lambda n: max(20, int(n * scale))
    of = lambda seed, number: [Source("studies/right_calibration.yaml", seed, draws(number), 4, listing="second_motions")]
    return of(74, 4000), of(83, 2000)


def sources(scale):
    """(training, held out) of the check; `scale` 1 for the committed constants."""
    draws = lambda n: max(20, int(n * scale))
    training = [Source("studies/right_calibration.yaml", 51, draws(6000), 4), Source("studies/any_condition.yaml", 55, draws(3000), 4, fits_covariance=False)]
    training += [Source(f"studies/calibrated/{family}.yaml", 53, None, max(2, int(20 * scale)), OF_FAMILY) for family in FAMILIES]
    training.append(Source("studies/right_calibration.yaml", 54, draws(300), 4, OF_RANDOM, fits_covariance=False, listing="permuted"))
    held_out = [Source("studies/right_calibration.yaml", 86, draws(1200), 4), Source("studies/any_condition.yaml", 87, draws(600), 4),
                Source("studies/right_calibration.yaml", 88, draws(100), 6, listing="permuted")]
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
    """Rows of the sources as arrays: signs, spread terms, posterior and its log-odds, outcome, cluster, regime."""

    def __init__(self, files, sources):
        rows, self.weight, self.cluster, self.fits_covariance, self.is_permuted, self.population = [], [], [], [], [], []
        for k, (path, source) in enumerate(zip(files, sources)):
            with open(path, newline="") as file:
                for row in csv.DictReader(file):
                    rows.append(row)
                    self.weight.append(source.weight)
                    self.fits_covariance.append(source.fits_covariance)
                    self.is_permuted.append(source.listing == "permuted")
                    self.population.append(source.population())
                    self.cluster.append((k, row["condition"]))
        self.names = [key for key in rows[0] if key.startswith("sign_")]
        self.spread_names = [key for key in rows[0] if key.startswith("spread_")]
        column = lambda key: np.array([float(row[key]) for row in rows])
        self.x = np.column_stack([column(key) for key in self.names])
        self.spread = np.column_stack([column(key) for key in self.spread_names])
        self.posterior, self.nees, self.failed = column("posterior"), column("nees"), column("failed")
        with np.errstate(divide="ignore"):
            self.log_odds = np.clip(np.log(self.posterior / (1 - self.posterior)), -MOST_LOG_ODDS, MOST_LOG_ODDS)
        self.weight, self.fits_covariance, self.is_permuted = (np.array(x) for x in (self.weight, self.fits_covariance, self.is_permuted))
        _, self.cluster = np.unique([f"{k}:{c}" for k, c in self.cluster], return_inverse=True)
        self.regime = np.array([self._regime(row) for row in rows])
        self.population = np.array(self.population)

    def where(self, here):
        """The trials for which the array `here` is true."""
        part = copy.copy(self)
        for name, value in vars(self).items():
            if isinstance(value, np.ndarray):
                setattr(part, name, value[here])
        return part

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


class Hinge:
    """max(direction (x - knot), 0) of the sign in a column."""

    def __init__(self, column, direction, knot):
        self.column, self.direction, self.knot = column, direction, knot

    def values(self, x):
        return np.maximum(self.direction * (x[:, self.column] - self.knot), 0.0)


class Product:
    """One or two hinges; where it tempers, times the log-odds."""

    def __init__(self, tempers, hinges):
        self.tempers, self.hinges = tempers, hinges

    def values(self, x, log_odds):
        value = log_odds if self.tempers else np.ones(len(x))
        for hinge in self.hinges:
            value = value * hinge.values(x)
        return value

    def text(self, names):
        parts = [f"({names[h.column].removeprefix('sign_')} - {h.knot:.3g})+" if h.direction > 0
                 else f"({h.knot:.3g} - {names[h.column].removeprefix('sign_')})+" for h in self.hinges]
        return " ".join(["log-odds"] * self.tempers + parts)


class Check:
    """The probability of failure of a fit: ranges of the signs, products, and the weights of 1, the log-odds, the posterior and these."""

    def __init__(self, ranges, products, weights):
        self.ranges, self.products, self.weights = ranges, products, weights

    def cut(self, x):
        return np.clip(x, self.ranges[1:, 0], self.ranges[1:, 1])

    def design(self, trials, products=None):
        x = self.cut(trials.x)
        columns = [p.values(x, trials.log_odds) for p in (self.products if products is None else products)]
        return np.column_stack([np.ones(len(x)), trials.log_odds, trials.posterior, *columns])

    def probability(self, trials):
        """As CheckedFailureProbability has it."""
        terms = self.design(trials) * self.weights
        tempers = np.array([False, True, False] + [p.tempers for p in self.products])
        slope = np.divide(terms[:, tempers].sum(axis=1), trials.log_odds, out=np.zeros(len(terms)), where=trials.log_odds != 0)
        return logistic(np.maximum(slope, LEAST_SLOPE) * trials.log_odds + terms[:, ~tempers].sum(axis=1))

    def is_in_domain(self, trials):
        """As IsInDomain has it."""
        values = np.column_stack([trials.log_odds, trials.x])
        return ((values >= self.ranges[:, 0]) & (values <= self.ranges[:, 1])).all(axis=1)


def fit_failure(x, failed, weight, ridge=FORM.ridge, has_constant=True, known=0.0):
    """Weights of a ridge logistic regression by Newton's method; where there is a constant it is the first column. `known`: log-odds to add."""
    mean, scale = x.mean(axis=0), x.std(axis=0)
    if not has_constant:
        mean, scale = np.zeros(x.shape[1]), np.sqrt((x**2).mean(axis=0))
    else:
        mean[0], scale[0] = 0.0, 1.0
    scale[scale == 0] = 1.0
    b = newton((x - mean) / scale, failed, weight, np.zeros(x.shape[1]), ridge, has_constant, known)
    b /= scale
    if has_constant:
        b[0] -= b[1:] @ mean[1:]
    return b


def penalty_of(number, weight, ridge, has_constant=True):
    return ridge * np.diag([0.0 if has_constant else 1.0] + [1.0] * (number - 1)) * weight.sum()


def newton(z, failed, weight, b, ridge, has_constant=True, known=0.0):
    """Ridge logistic regression on standardised columns, begun at b; a step that does not gain is halved."""
    penalty = penalty_of(z.shape[1], weight, ridge, has_constant)

    def loss(b):
        log_odds = z @ b + known
        return weight @ (np.logaddexp(0, log_odds) - failed * log_odds) + 0.5 * b @ penalty @ b

    now = loss(b)
    for _ in range(50):
        p = logistic(z @ b + known)
        hessian = (z * (weight * np.maximum(p * (1 - p), 1e-6))[:, None]).T @ z + penalty
        step = np.linalg.solve(hessian, z.T @ (weight * (failed - p)) - penalty @ b)
        while (after := loss(b + step)) > now and np.abs(step).max() > 1e-10:
            step = step / 2
        b, now = b + step, after
        if np.abs(step).max() < 1e-8:
            break
    return b


def standardised(column):
    spread = column.std()
    return (column - column.mean()) / spread if spread > 1e-9 else np.zeros(len(column))


def list_hinges(x):
    """At the quantiles of every sign, either way, but for those that are 0 or linear all over the trials."""
    hinges = []
    for column in range(x.shape[1]):
        for knot in sorted(set(np.quantile(x[:, column], KNOTS))):
            hinges += [Hinge(column, 1, knot)] if knot < x[:, column].max() else []
            hinges += [Hinge(column, -1, knot)] if knot > x[:, column].min() else []
    return hinges


def list_candidates(values, parents, residual, curvature):
    """(score, parent, hinge) of the products that promise most: squared score over the curvature beside a constant."""
    found = []
    for k, (_, of_parent) in enumerate(parents):
        score = (residual * of_parent) @ values
        mean = (curvature * of_parent) @ values
        square = (curvature * of_parent**2) @ values**2
        scores = score**2 / np.maximum(square - mean**2 / curvature.sum(), 1e-3 * square + 1e-9)
        found += [(scores[j], k, j) for j in np.argsort(-scores)[:5]]
    return sorted(found, key=lambda candidate: -candidate[0])[:BEST_BY_CURVATURE]


def choose_products(x, log_odds, posterior, failed, weight, form):
    """The products, in the order in which they are chosen: of a hinge, of the log-odds and a hinge, or of a chosen hinge and another."""
    hinges = list_hinges(x)
    values = np.column_stack([hinge.values(x) for hinge in hinges])
    z = np.column_stack([np.ones(len(x)), standardised(log_odds), standardised(posterior)])
    b, products = newton(z, failed, weight, np.zeros(3), form.ridge), []
    while len(products) < form.products:
        p = logistic(z @ b)
        residual, curvature = weight * (failed - p), weight * p * (1 - p)
        singles = [q.hinges[0] for q in products if not q.tempers and len(q.hinges) == 1]
        parents = [((False, []), np.ones(len(x))), ((True, []), log_odds)] + [((False, [h]), h.values(x)) for h in singles]
        inverse = np.linalg.inv((z * curvature[:, None]).T @ z + penalty_of(z.shape[1], weight, form.ridge))
        best, chosen = 0.0, None
        for _, k, j in list_candidates(values, parents, residual, curvature):
            (tempers, before), of_parent = parents[k]
            if any(h.column == hinges[j].column for h in before) or is_chosen(products, tempers, [*before, hinges[j]]):
                continue
            column = standardised(of_parent * values[:, j])
            across = (z * curvature[:, None]).T @ column
            score = (residual @ column)**2 / (curvature @ column**2 - across @ inverse @ across + form.ridge * weight.sum())
            if score > best:
                best, chosen = score, (Product(tempers, [*before, hinges[j]]), column)
        products.append(chosen[0])
        z = np.column_stack([z, chosen[1]])
        b = newton(z, failed, weight, np.append(b, 0.0), form.ridge)
    return products


def is_chosen(products, tempers, hinges):
    return any(q.tempers == tempers and q.hinges == hinges for q in products)


def fit_of_products(check, train, products, ridge=FORM.ridge):
    """Weights of 1, the log-odds, the posterior and products; the posterior's is 0 where it would be less, for P grows with it."""
    design = check.design(train, products)
    weights = fit_failure(design, train.failed, train.weight, ridge)
    if weights[2] < 0.0:
        rest = [k for k in range(design.shape[1]) if k != 2]
        weights[rest], weights[2] = fit_failure(design[:, rest], train.failed, train.weight, ridge), 0.0
    return weights


def fit_probability(train, form=FORM):
    """Random partners are no domain in which P could be verified: the ranges are those of the other trials."""
    known = np.column_stack([train.log_odds, train.x])[~train.is_permuted]
    check = Check(np.quantile(known, [OUTSIDE, 1 - OUTSIDE], axis=0).T, [], None)
    check.products = choose_products(check.cut(train.x), train.log_odds, train.posterior, train.failed, train.weight, form)
    check.weights = fit_of_products(check, train, check.products, form.ridge)
    return check


def cross_validate(train, form):
    """The probability of each trial by a fit without the conditions of its fold."""
    fold = np.random.default_rng(1).integers(FOLDS, size=train.cluster.max() + 1)[train.cluster]
    p = np.empty(len(fold))
    for k in range(FOLDS):
        p[fold == k] = fit_probability(train.where(fold != k), form).probability(train.where(fold == k))
    return p


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
    """A line per source."""
    return [f"{s.study}, seed {s.seed}, " + (f"{s.number} draws, " if s.number else "") + f"{s.trials} trials of each condition"
            + (f", weight {s.weight}" if s.weight != 1 else "") + (", partners permuted" if s.listing == "permuted" else "") + ("" if s.fits_covariance else ", for P alone") for s in training]


def write_array(name, rows, training=None):
    """Replaces an array of the header, and where there is one the comment above it: the trials that it was fitted to."""
    made = "" if training is None else "// Fitted to\n//\n" + "".join(f"//   {line}\n" for line in describe_sources(training))
    text = HEADER.read_text()
    old = re.search((r"// Fitted to\n(//[^\n]*\n)*" if training is not None else "") + rf"(inline constexpr \w+ {name}\[\] = {{\n).*?\n}};\n", text, re.DOTALL)
    head = old.group(old.lastindex)
    HEADER.write_text(text[:old.start()] + made + head + "".join(f"    {row},\n" for row in rows) + "};\n" + text[old.end():])


def weight_rows(keys, weights):
    return [f'{{"{key}", {weight:.9g}}}' for key, weight in zip(keys, weights)]


def hinge_text(names, hinge):
    return f'{{"{names[hinge.column].removeprefix("sign_")}", {hinge.direction}, {hinge.knot:.9g}}}'


def product_row(names, weight, product):
    hinges = ", true, ".join(hinge_text(names, hinge) for hinge in product.hinges)
    return f'{{{weight:.9g}, {"true" if product.tempers else "false"}, {hinges}}}'


def write_check(training, train, check, spread):
    write_array("kFailureTerms", weight_rows(["constant", "posterior_log_odds", "posterior"], check.weights), training)
    write_array("kFailureProducts", [product_row(train.names, *one) for one in zip(check.weights[3:], check.products)])
    names = ["posterior_log_odds"] + [name.removeprefix("sign_") for name in train.names]
    write_array("kSignRanges", [f'{{"{name}", {least:.9g}, {most:.9g}}}' for name, (least, most) in zip(names, check.ranges)])
    write_array("kSpreadTerms", weight_rows([name.removeprefix("spread_") for name in train.spread_names], spread),
                [source for source in training if source.fits_covariance])


def read_array(name):
    """Lines of an array of the header, without their braces."""
    array = re.search(rf"{name}\[\] = {{\n(.*?)\n}};", HEADER.read_text(), re.DOTALL)[1]
    return [line.strip() for line in array.splitlines()]


def read_numbers(name):
    """Rows of numbers of an array whose rows begin with a name."""
    return np.array([[float(x) for x in row.rstrip("},").split(", ")[1:]] for row in read_array(name)])


def read_product(row, names):
    """(weight, product) of a line of kFailureProducts."""
    weight, tempers = re.match(r"{([^,]+), (true|false)", row).groups()
    hinges = [Hinge(names.index("sign_" + sign), float(direction), float(knot))
              for sign, direction, knot in re.findall(r'{"(\w+)", ([^,]+), ([^}]+)}', row)]
    return float(weight), Product(tempers == "true", hinges)


def read_header(names):
    """(the check, the weights of the covariance's terms) as they are in the program."""
    products = [read_product(row, names) for row in read_array("kFailureProducts")]
    weights = np.concatenate([read_numbers("kFailureTerms")[:, 0], [weight for weight, _ in products]])
    return Check(read_numbers("kSignRanges"), [product for _, product in products], weights), read_numbers("kSpreadTerms")[:, 0]


def is_same(now, fitted):
    now, fitted = np.asarray(now), np.asarray(fitted)
    return now.shape == fitted.shape and np.allclose(now, fitted, rtol=1e-4, atol=1e-6)


def is_same_check(now, fitted, names):
    return is_same(now.weights, fitted.weights) and [p.text(names) for p in now.products] == [p.text(names) for p in fitted.products]


def write_tables(programs, folder, train, held_out, tests):
    check, spread = read_header(train.names)
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / "held_out.csv", "w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["population", "regime", "conditions", "quantity", "before", "after"])
        for source, test in zip(held_out, tests):
            factor = np.maximum(1.0, np.exp(test.spread @ spread))
            table.writerows(report(programs, source, test, check.probability(test), factor, check.is_in_domain(test)))
    with open(folder / "terms.csv", "w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["term", "weight"])
        for name, weight in zip(["constant", "log-odds", "posterior", *(p.text(train.names) for p in check.products)], check.weights):
            table.writerow([name, f"{weight:.4g}"])
        for name, weight in zip(train.spread_names, spread):
            table.writerow(["covariance: " + name[len("spread_"):], f"{weight:.4g}"])
    write_signs_table(folder, check, train, tests[0])


def write_signs_table(folder, check, train, test):
    """What leaving out a sign costs on held-out trials: the others' products, fitted again. Without its own they are fewer."""
    def loss(products):
        less = Check(check.ranges, products, fit_of_products(check, train, products))
        return log_loss(less.probability(test), test.failed, test.weight)

    base = loss(check.products)
    with open(folder / "signs.csv", "w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["sign", "products", "log_loss_more_without"])
        for column, name in enumerate(train.names):
            rest = [p for p in check.products if all(hinge.column != column for hinge in p.hinges)]
            number = len(check.products) - len(rest)
            table.writerow([name.removeprefix("sign_"), number, f"{loss(rest) - base:.4f}" if number else ""])
        table.writerow(["all", len(check.products), f"{loss([]) - base:.4f}"])


def write_terms_table(made, train, test, b):
    """What each term costs when it is left out, on trials that were not fitted to."""
    made.parent.mkdir(parents=True, exist_ok=True)
    with open(made, "w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["term", "weight", "log_loss_more_without", "wrong_mode_more_without_percent"])
        for weight, name in zip(b, train.names):
            without = fit_mode_terms(train, name)
            table.writerow([name[len("mode_"):], f"{weight:.4g}", f"{test.log_loss(without) - test.log_loss(b):.4f}",
                            f"{100 * (test.wrong(without) - test.wrong(b)):.2f}"])
        table.writerow(["all", "", f"{test.log_loss(b):.4f}", f"{100 * test.wrong(b):.2f}"])


def fit_mode_terms(train, left_out=None):
    """All weights, then those of the prior's terms reduced and the others fitted again beside them. That of the term left out is 0."""
    terms = np.array([name != left_out for name in train.names])
    is_prior = np.array([name in PRIOR_TERMS for name in train.names])
    fit = lambda columns, known: fit_failure(train.x[:, columns], np.ones(len(train.x)), train.weight, RIDGE_OF_MODES, has_constant=False, known=known)
    b = np.zeros(len(train.names))
    b[terms] = fit(terms, 0.0)
    b[is_prior] *= PRIOR_SHARE
    others = terms & ~is_prior
    b[others] = fit(others, train.x[:, is_prior] @ b[is_prior])
    return b


def fit_terms(array, made, training, held_out, arguments):
    """Fits an array of weights to pairs of modes; whether it is what the header has."""
    files = make_all(training + held_out, arguments)
    train = ModePairs(files[:len(training)], training)
    b = fit_mode_terms(train)
    if not arguments.report_only:
        write_array(array, weight_rows([name.removeprefix("mode_") for name in train.names], b), training)
    write_terms_table(arguments.out / made, train, ModePairs(files[len(training):], held_out), b)
    return is_same(read_numbers(array)[:, 0], b)


def fit_modes(arguments):
    return fit_terms("kModeTerms", "modes.csv", *sources_of_modes(arguments.scale), arguments)


def fit_second_motions(arguments):
    return fit_terms("kSecondMotionTerms", "second_motions.csv", *sources_of_second_motions(arguments.scale), arguments)


def fit_check(arguments):
    training, held_out = sources(arguments.scale)
    files = make_all(training + held_out, arguments)
    train = Trials(files[:len(training)], training)
    check = fit_probability(train)
    sure = train.fits_covariance & (check.probability(train) <= SURE) & np.isfinite(train.nees) & (train.nees > 0)
    spread = fit_spread(train.spread[sure], train.nees[sure], train.weight[sure])
    if not arguments.report_only:
        write_check(training, train, check, spread)
    tests = [Trials([path], [source]) for path, source in zip(files[len(training):], held_out)]
    write_tables(arguments.programs, arguments.out, train, held_out, tests)
    now, now_spread = read_header(train.names)
    return is_same_check(now, check, train.names) and is_same(now_spread, spread)


def compare_forms(arguments):
    """Writes the log loss of each form, and what failed of the answers of right_calibration that it is sure of. Changes nothing."""
    training, _ = sources(arguments.scale)
    train = Trials(make_all(training, arguments), training)
    arguments.out.mkdir(parents=True, exist_ok=True)
    with open(arguments.out / "cross_validation.csv", "w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["products", "ridge", "log_loss", "sure_answers", "sure_failed_percent"])
        for form in TRIED_FORMS:
            p = cross_validate(train, form)
            sure = (p <= 0.1) & (train.population == "right_calibration")
            table.writerow([form.products, form.ridge, f"{log_loss(p, train.failed, train.weight):.4f}", sure.sum(),
                            f"{100 * train.failed[sure].mean():.2f}" if sure.any() else ""])
    return True


def make_all(sources, arguments):
    files = []
    for source in sources:
        files.append(make_trials(source, arguments.programs, arguments.trials, arguments.resume))
        print(f"{len(files)} of {len(sources)} populations and families", file=sys.stderr)
    return files


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    job = parser.add_mutually_exclusive_group()
    job.add_argument("--modes", action="store_true", help="the weights of the modes, in place of the check")
    job.add_argument("--second-motions", action="store_true", help="the weights of two motions, the camera's and an object's")
    job.add_argument("--cross-validate", action="store_true", help="only compare numbers of products and ridges of the check")
    parser.add_argument("--programs", default=ROOT / "build/release/bin", type=pathlib.Path, help="folder of the two programs")
    parser.add_argument("--trials", default=ROOT / "build/fit_calibrated", type=pathlib.Path, help="folder of the trials")
    parser.add_argument("--resume", action="store_true", help="take trials that are there as they are")
    parser.add_argument("--out", default=ROOT / "results/right_calibration", type=pathlib.Path, help="folder of the tables")
    parser.add_argument("--scale", type=float, default=1.0, help="share of the trials, to try the script")
    parser.add_argument("--report-only", action="store_true", help="leave the constants as they are; exit code 1 if a fit gives others")
    arguments = parser.parse_args()
    arguments.trials.mkdir(parents=True, exist_ok=True)
    do = fit_modes if arguments.modes else fit_second_motions if arguments.second_motions else compare_forms if arguments.cross_validate else fit_check
    if not do(arguments):
        sys.exit("fit_calibrated: the constants of estimator/calibrated/fitted_constants.h are not those of this fit")


if __name__ == "__main__":
    main()
