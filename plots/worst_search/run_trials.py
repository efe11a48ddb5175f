"""The trials of a search, made by `rcme run`: each request is a study file and a result file of its own in a folder. A
request that was answered is not run again, so that a search that was killed goes on where it was."""

import csv
import io
import json
import math
import os
import time
import zlib

import numpy as np
import yaml

from common.command_line import PlotError
from common.number_text import is_number
from common.whole_file import write_text
from worst_search.objective import Objective, Tried
from worst_search.run_rcme import run_rcme
from worst_search.space import ABSENT

SURE_BELOW, SURE_OF_COVERAGE = 0.1, 0.01  # stated probabilities of failure, as in `rcme marginals`
COVERED_BELOW = 11.0705  # the 95 % point of chi square with five degrees of freedom
MOST_DRAWS = 10_000  # in the study of one request: a study file has a limit to its values
NOT_THERE = -1  # an event that a trial does not have: it does not count

QUANTITIES = {"failure": "share of the trials that failed",
              "sure_failure": f"share that failed, of the answers with a stated P <= {SURE_BELOW:g}",
              "miscoverage": "share of the truths outside of the stated 95 % region, of answers with P <= "
                             f"{SURE_OF_COVERAGE:g}, or of successes if the estimator states no P",
              "difference": "share of the trials that failed, less that of the other estimator"}
SHARPNESS = ("sd_over_crb", "rotation_sd_deg", "direction_sd_deg")  # beside a miscoverage: wide regions cover
STATEMENTS = {"sure_failure": ("failure_probability", "a probability of failure"),  # column and name of what answers have to state
              "miscoverage": ("rotation_sd_deg", "a covariance")}
CLAIMS = {"failure": 0.5, "sure_failure": SURE_BELOW, "miscoverage": 0.05, "difference": 0.0}


class PlainDumper(yaml.SafeDumper):
    """Texts without quotes, as a person writes numbers."""
    yaml_implicit_resolvers = {}

    def represent_text(self, text):
        return self.represent_scalar("tag:yaml.org,2002:str", text, style=None if text else '"')


PlainDumper.add_representer(str, PlainDumper.represent_text)


def read_study(path):
    with open(path, encoding="utf-8") as file:
        return yaml.load(file, Loader=yaml.BaseLoader)  # all values as texts


def all_texts(value):
    if isinstance(value, dict):
        return {key: all_texts(part) for key, part in value.items()}
    return [all_texts(part) for part in value] if isinstance(value, list) else str(value)


def read_text(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def study_text(study):
    return yaml.dump(all_texts(study), Dumper=PlainDumper, sort_keys=False, default_flow_style=None, width=120)


def number_text(value):
    return f"{value:.6g}"


def narrow_words(words, limit):
    """Those of a list that a limit allows, as often as they stand there."""
    if isinstance(limit, frozenset):
        return [word for word in words if word in limit]
    return [word for word in words if not is_number(word) or limit[0] <= float(word) <= limit[1]]


def narrow_range(key, value, limit, limits, is_whole):
    """What a key is drawn from within a limit; None: nothing of it lies there."""
    if isinstance(value, dict) and set(value) == {"any"}:
        words = narrow_words(value["any"], limit) if limit else value["any"]
        return None if not words else words[0] if len(words) == 1 else {"any": words}
    if isinstance(value, dict) and set(value) != {"log"}:  # words with what is drawn with them alone
        kept = {}
        for word in narrow_words(value, limit) if limit else value:
            inside = narrow_ranges(value[word] or {}, limits, is_whole)
            if inside is not None:
                kept[word] = inside
        return kept or None
    if limit is None:
        return value
    if isinstance(value, str):
        return value if narrow_words([value], limit) else None
    ends = value["log"] if isinstance(value, dict) else value
    lower, upper = max(float(ends[0]), limit[0]), min(float(ends[1]), limit[1])
    if is_whole(key):
        lower, upper = math.ceil(lower), math.floor(upper)
    if lower > upper:
        return None
    if lower == upper:
        return number_text(lower)
    narrowed = [number_text(lower), number_text(upper)]
    return {"log": narrowed} if isinstance(value, dict) else narrowed


def narrow_ranges(ranges, limits, is_whole):
    """The ranges of a population's draws within limits; None: there are none."""
    narrowed = {}
    for key, value in ranges.items():
        narrowed[key] = narrow_range(key, value, limits.get(key), limits, is_whole)
        if narrowed[key] is None:
            return None
    return narrowed


def words_left(value):
    """The words that a key is drawn from, of its range as a study has it; empty: it is a number."""
    if isinstance(value, str):
        return set() if is_number(value) else {value}
    if isinstance(value, dict) and set(value) == {"any"}:
        return {word for word in value["any"] if not is_number(word)}
    return set(value) if isinstance(value, dict) and set(value) != {"log"} else set()


def brought_keys(space, ranges):
    """The keys that draws from these ranges have: others belong to words that are not among them."""
    columns = space.pool.columns
    there = {key: ~np.isnan(columns[key]) if space.numeric[key] else columns[key] != ABSENT for key in space.keys}
    for word_key, value in ranges.items():
        words = words_left(value)
        if words and not space.numeric[word_key]:
            inside = np.isin(columns[word_key].astype(str), sorted(words) + [ABSENT])
            there = {key: here for key, here in there.items() if np.any(here & inside)}
    return set(there)


def narrowed_conditions(conditions, space, box, number, design):
    """The block of a study whose draws are those of a population that lie in a box."""
    limits = dict(box.limits)
    ranges = {}
    for key, value in conditions["ranges"].items():
        narrowed = narrow_range(key, value, limits.get(key), limits, lambda k: space.is_whole[k])
        ranges[key] = value if narrowed is None else narrowed  # a word may bring a range of its own
    brought = brought_keys(space, ranges)
    ranges = {key: value for key, value in ranges.items() if key in brought}
    given = list(conditions.get("given", []))
    in_box = box.contains(space.pool)
    for key, limit in box.limits:
        # Not of keys that some draws of the box lack: the condition would be on their default, and exclude those draws.
        is_in_all = not isinstance(limit, frozenset) and not np.isnan(space.pool.columns[key][in_box]).any()
        if is_in_all and key in brought:
            given += [f"{key} {sign} {number_text(end)}" for sign, end in zip((">=", "<="), limit) if math.isfinite(end)]
    return {"design": design, "number": number, "ranges": ranges, **({"given": given} if given else {})}


def event_of(quantity, row):
    """1, 0 or NOT_THERE, of one answer as `rcme summarize --raw csv` gives it."""
    outcome, nees, stated = row["outcome"], row["nees"], row["failure_probability"]
    if outcome == "not_scored":
        return NOT_THERE
    if quantity in ("failure", "difference"):
        return int(outcome == "failure")
    if outcome not in ("success", "failure"):
        return NOT_THERE
    if quantity == "sure_failure":
        # P is of rotation and direction: not judged without a true direction, as in `rcme reliability`; an invalid answer has failed.
        is_judged = row["direction_error_deg"] or row["status"] != "ok"
        return int(outcome == "failure") if is_judged and stated and float(stated) <= SURE_BELOW else NOT_THERE
    is_sure = float(stated) <= SURE_OF_COVERAGE if stated else outcome == "success"
    return int(float(nees) > COVERED_BELOW) if is_sure and nees else NOT_THERE


def sharpness_of(rows):
    """{column: median over these answers}, None where none states it."""
    known = {key: [float(row[key]) for row in rows if row.get(key)] for key in SHARPNESS}
    return {key: float(np.median(values)) if values else None for key, values in known.items()}


class TrialsOfRun(Objective):
    """`folder` holds study.yaml; `pool`: {number of the draw: levels} in order."""

    def __init__(self, folder, rcme, space, numbers, quantity, labels, threads, more=(), say=lambda calls: None):
        self.folder, self.rcme, self.space, self.numbers = folder, rcme, space, numbers
        self.quantity, self.labels, self.threads, self.more, self.say = quantity, labels, threads, list(more), say
        self.study = read_study(os.path.join(folder, "study.yaml"))
        self.is_difference, self.calls, self.seconds = quantity == "difference", 0, 0.0
        self.what_counts = f"{quantity} is the {QUANTITIES[quantity]}."
        self.num_answers, self.num_stating = 0, 0  # of the first estimator; with what the quantity needs
        os.makedirs(os.path.join(folder, "trials"), exist_ok=True)

    def path(self, name, suffix):
        return os.path.join(self.folder, "trials", name + suffix)

    def try_draws(self, name, numbers, trials, first=0):
        numbers = np.asarray(numbers)
        parts = [self.try_some_draws(f"{name}_{begin}" if begin else name, numbers[begin:begin + MOST_DRAWS], trials, first)
                 for begin in range(0, len(numbers), MOST_DRAWS)]
        counts = {key: np.concatenate([getattr(part, key) for part in parts]) for key in ("events", "trials", "reverse")}
        return Tried(self.space.pool.take(numbers), **counts)

    def try_some_draws(self, name, numbers, trials, first):
        draws = [int(self.numbers[i]) for i in numbers]
        conditions = {key: value for key, value in self.study["conditions"].items() if key != "draws"}
        conditions["draws"] = draws
        answer = self.ask(name, {**self.study, "trials": trials, "conditions": conditions}, first)
        place = {draw: i for i, draw in enumerate(answer["draws"])}
        there = [place.get(draw) for draw in draws]
        column = {key: np.array([0 if i is None else answer[key][i] for i in there])
                  for key in ("events", "trials", "reverse")}
        return Tried(self.space.pool.take(numbers), **column)

    def study_of_box(self, name, box, number, design="sobol"):
        seed = int(self.study["seed"]) + 1 + zlib.crc32(name.encode())
        conditions = narrowed_conditions(self.study["conditions"], self.space, box, number, design)
        return {**self.study, "seed": seed, "trials": 1, "conditions": conditions}

    def try_box(self, name, box, number):
        design = "random" if name.startswith("fresh") else "sobol"  # an exact interval needs independent draws
        answer = self.ask(name, self.study_of_box(name, box, number, design), 0)
        table = self.space.table(answer["levels"])
        tried = Tried(table, *(np.array(answer[key]) for key in ("events", "trials", "reverse")))
        return tried.subset(box.contains(table))

    def ask(self, name, study, first):
        """{draws, levels, events, trials, reverse, seconds}, by condition."""
        answer, asked = self.path(name, ".json"), self.path(name, ".yaml")
        if not os.path.exists(answer):
            self.run(name, study)
            write_text(answer, json.dumps(self.read(name, first)))
        elif read_text(asked) != study_text(study):
            raise PlotError(f"{asked} asks for other trials than this search does now (of another version of rcme?); give "
                            "another folder.")
        with open(answer, encoding="utf-8") as file:
            found = json.load(file)
        self.calls += found["calls"]
        self.seconds += found["seconds"]
        self.check_statements(found)
        self.say(self)
        return found

    def check_statements(self, found):
        """An estimator that never states what the quantity is about would use up all trials for nothing."""
        self.num_answers += found.get("answers", 0)
        self.num_stating += found.get("stating", 0)
        if self.num_answers and not self.num_stating:
            raise PlotError(f"no answer of {self.labels[0]} states {STATEMENTS[self.quantity][1]}; {self.quantity} needs an "
                            "estimator that does.")

    def run(self, name, study):
        write_text(self.path(name, ".yaml"), study_text(study))
        start = time.monotonic()
        command = [self.rcme, "run", self.path(name, ".yaml"), "--out", self.path(name, ".sqlite"), "--threads",
                   str(self.threads), *self.more]
        end = run_rcme(command)
        if end.returncode != 0:
            raise PlotError(f"trials of {name} stopped: {end.stderr.strip().splitlines()[-1:]}; the same command goes on.")
        self.last_seconds = time.monotonic() - start

    def read(self, name, first):
        command = [self.rcme, "summarize", self.path(name, ".sqlite"), "--raw", "csv"]
        table = run_rcme(command)
        if table.returncode != 0:
            raise PlotError(f"{name}: {table.stderr.strip()}")
        rows = csv.DictReader(io.StringIO(table.stdout))
        levels, answers, num_calls = {}, {label: {} for label in self.labels}, 0
        measured = []  # of a miscoverage, the answers that count
        is_stating = []  # of the first estimator's valid answers
        names = rows.fieldnames[3:rows.fieldnames.index("trial")]  # after study, condition, draw
        columns = {name if name in self.space.keys else name.removeprefix("level_"): name for name in names}
        for row in rows:
            condition, trial = int(row["condition"]), int(row["trial"])
            levels.setdefault(condition, (int(row["draw"]), [row[columns[key]].removeprefix("'") if key in columns else ABSENT
                                                                for key in self.space.keys]))
            num_calls += row["estimator"] == self.labels[0]
            if row["estimator"] == self.labels[0] and row["status"] == "ok" and self.quantity in STATEMENTS:
                is_stating.append(bool(row[STATEMENTS[self.quantity][0]]))
            if trial >= first:
                answers[row["estimator"]][condition, trial] = event_of(self.quantity, row)
                if self.quantity == "miscoverage" and answers[row["estimator"]][condition, trial] != NOT_THERE:
                    measured.append(row)
        counts = {condition: [0, 0, 0] for condition in levels}
        failing = []
        for key, event in sorted(answers[self.labels[0]].items()):
            other = answers[self.labels[1]][key] if self.is_difference else 0
            if NOT_THERE in (event, other):
                continue
            count = counts[key[0]]
            count[0] += event > other
            count[1] += 1
            count[2] += other > event
            if event > other:
                failing.append(list(key))
        order = sorted(levels)
        return {"draws": [levels[c][0] for c in order], "levels": [levels[c][1] for c in order],
                "events": [counts[c][0] for c in order], "trials": [counts[c][1] for c in order],
                "reverse": [counts[c][2] for c in order], "conditions": order, "failing": failing,
                "calls": num_calls, "seconds": round(self.last_seconds, 3),
                "answers": len(is_stating), "stating": sum(is_stating),
                **({"sharpness": sharpness_of(measured)} if self.quantity == "miscoverage" else {})}
