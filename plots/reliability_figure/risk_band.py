"""The interval of each point of a risk-coverage curve, of which reliability.json has the counts and no interval."""

Z = 1.959964  # of the normal law, for 95 %


def wilson(share, n):
    """(lower, upper): the approximate 95 % interval of a share of n independent trials (Wilson 1927)."""
    middle, half = share + Z**2 / (2 * n), Z * (share * (1 - share) / n + Z**2 / (4 * n**2))**0.5
    return max(0.0, (middle - half) / (1 + Z**2 / n)), min(1.0, (middle + half) / (1 + Z**2 / n))


def risk_band(entry, points):
    """[(coverage, lower, upper)] at these points of the curve; none where trials belong to draws of a population, since they are
    not independent then."""
    if entry.is_of_population:
        return []
    return [(coverage, *wilson(risk, max(1, round(coverage * (entry.n + entry.refused))))) for coverage, risk in points]
