#!/usr/bin/env python3
"""Table I from the ramps in docs/reproduction/runs/table1 (`docs/reproduction/draw runs` unpacks them), apart from the crate: states from the tables, everything else from the paper's equations.

    docs/reproduction/table1/recompute.py           the evaluation that protocol.md fixes
    docs/reproduction/table1/recompute.py --vary    the same with other windows, legs, criteria, and accounts of the loss

Needs Python 3 only. The ramps of the base as stated that were there before are in docs/reproduction/runs/full-length.
"""
import collections, csv, functools, math, pathlib, sys

RUNS = pathlib.Path(__file__).resolve().parent.parent / 'runs'
BEFORE = RUNS / 'full-length'
PAPER = {  # mean and standard deviation along a line
    ('0.002025', '0-1'): (-0.090, 0.017), ('0.002025', '1-2 (a)'): (-0.351, 0.042),
    ('0.002025', '1-2 (b)'): (-0.377, 0.046), ('0.002025', '2-collapse'): (-0.614, 0.036),
    ('0.015625', '0-1'): (-0.047, 0.009), ('0.015625', '1-2 (a)'): (-0.137, 0.022),
    ('0.015625', '1-2 (b)'): (-0.147, 0.025), ('0.015625', '2-collapse'): (-0.290, 0.037),
}
LINES = ['0-1', '1-2 (a)', '1-2 (b)', '2-collapse']
BASES = ('as-stated', 'elastic-normal', 'lossless')
GRAVITIES = ('0.002025', '0.015625')
LEVEL = {'conductive': 0, 'no roll': 0, 'one roll': 1, 'coexistence of one roll and two': 1.5, 'two rolls': 2, 'collapsed': 3}
MOST_LOSS = 0.3  # the friction at which the loss is largest, where one branch ends and the other begins


@functools.cache
def energy_change(friction, q, ratio=1.0, sticking=1 / 3):
    """The mean energy change of a collision, over the translational temperature: Eqs. (1)-(5) over a Maxwellian gas of disks.

    The closing speed v has the density (v/2) exp(-v²/4), the slip the variance 2 + 4 `ratio`, for spins of `ratio` times the temperature.
    With the ratio u of slip and closing speed, the integral over v can be done, and that over u remains. A sticking collision loses
    q(1 - q)(v² + slip²/3), which Eqs. (1)-(5) give; with `sticking` = 1 it loses what Eq. (6) says as printed.
    """
    def loss(u):
        if u <= 3 * friction:
            return q * (1 - q) * (1 + u * u * sticking)
        return (1 - q) * (q - 3 * (1 - q) * friction ** 2 + friction * u)
    variance = 2 + 4 * ratio
    steps, total = 5000, 0.0
    for step in range(steps):
        angle = (step + 0.5) / steps * math.pi / 2
        u = math.tan(angle)
        total += loss(u) * (0.25 + u * u / (2 * variance)) ** -2.5 * (1 + u * u)
    return -total * (math.pi / 2 / steps) * 3 * math.sqrt(math.pi) / 8 / math.sqrt(2 * math.pi * variance)


Seen = collections.namedtuple('Seen', 'friction level ratio')


def as_named(row):
    return LEVEL[row['state']]


def legs(folder, level=as_named):
    """Both legs, by friction: the states, and the ratio of the rotational to the translational temperature."""
    found = {'up': [], 'down': []}
    for row in csv.DictReader(open(folder / 'values.csv')):
        ratio = 2 * float(row['rotational_energy']) / float(row['translational_energy'])
        found[row['leg']].append(Seen(float(row['friction']), level(row), ratio))
    if found['down']:  # the way down begins at the last value of the way up
        found['down'].append(max(found['up']))
    return {leg: sorted(seen) for leg, seen in found.items() if seen}


def branches(leg):
    """Both branches of a leg, in the order of growing loss."""
    low = [seen for seen in leg if seen.friction <= MOST_LOSS]
    high = [seen for seen in reversed(leg) if seen.friction >= MOST_LOSS]
    return low, high


def crossing(branch, is_beyond, last=False):
    """The place between two neighbors, where a state is first beyond, or after which none falls back: friction and ratio of temperatures."""
    marks = [is_beyond(seen.level) for seen in branch]
    steps = [i for i in range(1, len(marks)) if marks[i] and not marks[i - 1]]
    if not steps or (last and not marks[-1]):
        return None
    before, after = branch[(index := steps[-1] if last else steps[0]) - 1], branch[index]
    return math.sqrt(before.friction * after.friction), (before.ratio + after.ratio) / 2


def places(folder, level=as_named, which=('up', 'down')):
    """The transitions of a ramp: line, branch, friction, ratio of temperatures."""
    for side in (0, 1):
        begins, ends = [], []
        for name, leg in legs(folder, level).items():
            if name not in which:
                continue
            branch = branches(leg)[side]
            for line, is_beyond in (('0-1', lambda level: level >= 1), ('2-collapse', lambda level: level == 3)):
                if at := crossing(branch, is_beyond):
                    yield line, side, *at
            begins.append(crossing(branch, lambda level: level > 1))
            ends.append(crossing(branch, lambda level: level >= 2, last=True))
        # The loss grows with the friction on the low branch, and falls with it on the high one.
        first, last = (min, max) if side == 0 else (max, min)
        if any(begins):
            yield '1-2 (a)', side, *first(filter(None, begins))
        if any(ends):
            yield '1-2 (b)', side, *last(filter(None, ends))


def ramps(base, gravity):
    """The ramps of a base: inelasticity and folder."""
    own = (RUNS / 'table1').glob(f'{base}-gravity-{gravity}-inelasticity-*-seed-1')
    found = {float(folder.name.split('-')[-3]): folder for folder in own}
    # Without inelasticity, all bases are one.
    before = '0.0' if base != 'as-stated' else '*'
    for folder in BEFORE.glob(f'gravity-{gravity}-inelasticity-{before}-seed-1'):
        found.setdefault(float(folder.name.split('-')[-3]), folder)
    return sorted(found.items())


def mean_and_deviation(values):
    mean = sum(values) / len(values)
    deviation = math.sqrt(sum((value - mean) ** 2 for value in values) / max(len(values) - 1, 1))
    return mean, deviation


def tail(square, lines):
    """The probability of a larger chi square with so many degrees of freedom."""
    half, odd = square / 2, lines % 2
    total = math.erfc(math.sqrt(half)) if odd else math.exp(-half)
    term = math.sqrt(half / math.pi) * 2 * math.exp(-half) if odd else math.exp(-half) * half
    order = 1.5 if odd else 2.0
    for _ in range((lines - (1 if odd else 2)) // 2):
        total += term
        term *= half / order
        order += 1
    return total


def collapsed_by(packing, order):
    """States with another criterion of the collapse; without a collapse, two rolls are left."""
    def level(row):
        if float(row['densest_packing']) > packing and abs(float(row['two_rolls'])) < order:
            return 3
        return min(LEVEL[row['state']], 2)
    return level


class Line(collections.namedtuple('Line', 'mean deviation points places error away')):
    """A row of Table I as it was found. The error of the mean takes places (one q, one branch) as independent."""
    @classmethod
    def of(cls, found, paper):
        mean, deviation = mean_and_deviation([change for _, change in found])
        by_place = collections.defaultdict(list)
        for place, change in found:
            by_place[place].append(change)
        scatter = mean_and_deviation([sum(them) / len(them) for them in by_place.values()])[1]
        error = scatter / math.sqrt(len(by_place)) if len(by_place) > 1 else math.nan
        return cls(mean, deviation, len(found), len(by_place), error, (mean - paper[0]) / error)


def measured(friction, q, ratio):
    return energy_change(friction, q, round(ratio, 4))


def table(of_base, gravity, change=lambda friction, q, ratio: energy_change(friction, q), window=(0, math.inf), **how):
    """The rows of Table I of one base at one gravity."""
    found = collections.defaultdict(list)
    for q, folder in of_base:
        for line, side, friction, ratio in places(folder, **how):
            if window[0] <= friction <= window[1]:
                found[line].append(((q, side), change(friction, q, ratio)))
    return {line: Line.of(found[line], PAPER[gravity, line]) for line in LINES if found[line]}


def verdict(tables):
    """Chi square over all lines, and the distance in the paper's standard deviations."""
    rows = [(row, PAPER[gravity, line]) for gravity, lines in tables.items() for line, row in lines.items() if row.places > 1]
    square = sum(row.away ** 2 for row, _ in rows)
    distance = math.sqrt(sum(((row.mean - mean) / width) ** 2 for row, (mean, width) in rows) / len(rows))
    return f'chi square {square:.0f} of {len(rows)} lines, p = {tail(square, len(rows)):.2g}; rms deviation {distance:.2f} of the paper\'s standard deviations'


def student(away, places):
    """The probability that a mean of so few places is as many of its own errors away: Student's t, two-sided."""
    freedom, steps = places - 1, 2000
    # With t = tan(angle) √freedom, the density is cos(angle)^(freedom - 1).
    least = math.atan(abs(away) / math.sqrt(freedom))
    weight = lambda begin: sum(
        math.cos(begin + (k + 0.5) / steps * (math.pi / 2 - begin)) ** (freedom - 1) for k in range(steps)
    ) * (math.pi / 2 - begin)
    return weight(least) / weight(0)


def by_student(tables):
    """The same verdict with errors that are themselves uncertain: p of each line, and of all together by Fisher's method."""
    rows = [(f'{line} at {gravity}', student(row.away, row.places)) for gravity, lines in tables.items() for line, row in lines.items() if row.places > 1]
    least = min(rows, key=lambda row: row[1])
    together = tail(-2 * sum(math.log(p) for _, p in rows), 2 * len(rows))
    return f"by Student's t: p = {together:.2g} of {len(rows)} lines together, least p = {least[1]:.2g} ({least[0]})"


def fixed():
    for base in BASES:
        tables = {}
        for gravity in GRAVITIES:
            of_base = ramps(base, gravity)
            if len(of_base) < 2:
                continue
            tables[gravity] = table(of_base, gravity)
            print(f'\nbase {base}, g = {gravity}, q =', ', '.join(f'{q:g}' for q, _ in of_base))
            print('line          paper            here             points  places  error   errors of the mean')
            for line, row in tables[gravity].items():
                mean, width = PAPER[gravity, line]
                print(f'{line:11} {mean:7.3f} ± {width:.3f}  {row.mean:7.3f} ± {row.deviation:.3f} {row.points:8} {row.places:7}  {row.error:.4f} {row.away:7.1f}')
        if tables:
            print(verdict(tables))


VARIATIONS = {
    'as fixed': {},
    'way up only': {'which': ('up',)},
    'way down only': {'which': ('down',)},
    'friction 0.01 to 1': {'window': (0.01, 1)},
    'friction 0.02 to 0.5': {'window': (0.02, 0.5)},
    'collapse: packing > 0.65': {'level': collapsed_by(0.65, 0.03)},
    'collapse: |Psi2| < 0.06': {'level': collapsed_by(0.60, 0.06)},
    'Eq. (6) as printed': {'change': lambda friction, q, ratio: energy_change(friction, q, 1.0, 1.0)},
    'T_rot/T of the runs': {'change': measured},
    'T_rot/T, friction < 0.3': {'change': measured, 'window': (0, MOST_LOSS)},
    'T_rot/T, friction >= 0.3': {'change': measured, 'window': (MOST_LOSS, math.inf)},
}


def vary():
    """Each variation in a row: mean, scatter along the line and distance from the paper in errors of the mean."""
    for base in BASES:
        for name, how in VARIATIONS.items():
            tables = {gravity: table(of_base, gravity, **how) for gravity in GRAVITIES if len(of_base := ramps(base, gravity)) > 1}
            for gravity, lines in tables.items():
                row = '  '.join(f'{line} {row.mean:.3f} ± {row.deviation:.3f} ({row.away:+.1f})' for line, row in lines.items())
                print(f'{base:14}  {name:24}  g = {gravity:8}  {row}')
            if tables and 'T_rot' not in name:
                print(f'{base:14}  {name:24}  {verdict(tables)}; {by_student(tables)}')


if __name__ == '__main__':
    vary() if sys.argv[1:] == ['--vary'] else fixed()
