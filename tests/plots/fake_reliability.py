"""A made-up reliability.json: values follow from no experiment, and no number stands there twice."""


def measured(value, lower=None, upper=None):
    return {"value": value, "standard_error": None, "interval": [lower, upper]}


def entry(estimator="rcme_calibrated", group="", source="stated", **changes):
    """Every number is another."""
    return {
        "estimator": estimator, "group": group, "source": source, "n": 100, "refused": 7, "without": 0,
        "mean_probability": 0.145, "failure": measured(0.13, 0.07, 0.21), "sure_failed": measured(0.0125, 0.0003, 0.068),
        "sure": measured(0.75, 0.66, 0.83), "brier": measured(0.031, 0.02, 0.05), "calibration_slope": measured(None), "area_under_curve":
        measured(0.91, 0.8, 0.97), "risk_coverage_area": measured(0.0123, 0.01, 0.015),
        "calibration_error": {"value": 0.021, "mean_if_calibrated": 0.013, "upper_if_calibrated": 0.03, "p_value": 0.2},
        "curve": [{"first": 0, "last": 0.05, "recalibrated": 0.01, "n": 80, "failed": 1},
                  {"first": 0.4, "last": 1, "recalibrated": 0.6, "n": 20, "failed": 12}],
        "band": [{"probability": p, "lower": 0.8 * p, "upper": min(1, 1.2 * p)} for p in (0, 0.5, 1)],
        "bins": [{"least": 0, "greatest": 0.05, "mean_probability": 0.02,
                  "failure": {"value": 0.0125, "interval": [0.001, 0.07], "n": 80}},
                 {"least": 0.4, "greatest": 1, "mean_probability": 0.7,
                  "failure": {"value": 0.6, "interval": [0.36, 0.81], "n": 20}}],
        "histogram": [80, 0, 5, 15],
        "risk_coverage": [{"probability": 0, "coverage": 0.5, "risk": 0.0}, {"probability": None, "coverage": 1,
                                                                             "risk": 0.18}], **changes}


def content(*entries, **changes):
    return {"format": "rcme reliability 1", "study": "demo", "by": "", "sure_below": 0.1,
            "histogram_edges": [0, 0.0625, 0.25, 0.5625, 1], "entries": list(entries), **changes}
