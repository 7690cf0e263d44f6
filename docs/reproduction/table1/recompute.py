#!/usr/bin/env python3
"""Table I from the ramps of this folder, apart from the crate: states from the tables, everything else from the paper's equations.

    docs/reproduction/table1/recompute.py

The rules of the evaluation are those of protocol.md. Needs Python 3 only. The ramps of the base as stated that were there before are in
docs/reproduction/runs (`docs/reproduction/draw runs`).
"""
import csv, math, pathlib

HERE = pathlib.Path(__file__).resolve().parent
BEFORE = HERE.parent / 'runs' / 'full-length'
PAPER = {  # mean and standard deviation along a line
    ('0.002025', '0-1'): (-0.090, 0.017), ('0.002025', '1-2 (a)'): (-0.351, 0.042),
    ('0.002025', '1-2 (b)'): (-0.377, 0.046), ('0.002025', '2-collapse'): (-0.614, 0.036),
    ('0.015625', '0-1'): (-0.047, 0.009), ('0.015625', '1-2 (a)'): (-0.137, 0.022),
    ('0.015625', '1-2 (b)'): (-0.147, 0.025), ('0.015625', '2-collapse'): (-0.290, 0.037),
}
LINES = ['0-1', '1-2 (a)', '1-2 (b)', '2-collapse']
LEVEL = {'conductive': 0, 'no roll': 0, 'one roll': 1, 'coexistence of one roll and two': 1.5, 'two rolls': 2, 'collapsed': 3}
MOST_LOSS = 0.3  # the friction at which the loss is largest, where one branch ends and the other begins


def energy_change(friction, q):
    """The mean energy change of a collision at temperature 1: Eqs. (1)-(5) over a Maxwellian gas of disks.

    The closing speed v has the density (v/2) exp(-v²/4), the slip the variance 6. With their ratio u for the slip, the integral over v
    can be done, and that over u remains. A sticking collision loses q(1 - q)(v² + slip²/3): Eq. (6) with the factor 1/3 that Eqs. (1)-(5) give.
    """
    def loss(u):
        if u <= 3 * friction:
            return q * (1 - q) * (1 + u * u / 3)
        return (1 - q) * (q - 3 * (1 - q) * friction ** 2 + friction * u)
    steps, total = 20000, 0.0
    for step in range(steps):
        angle = (step + 0.5) / steps * math.pi / 2
        u = math.tan(angle)
        total += loss(u) * (0.25 + u * u / 12) ** -2.5 * (1 + u * u)
    return -total * (math.pi / 2 / steps) * 3 * math.sqrt(math.pi) / 8 / math.sqrt(12 * math.pi)


def legs(folder):
    """The states along both legs, by friction."""
    found = {'up': [], 'down': []}
    for row in csv.DictReader(open(folder / 'values.csv')):
        found[row['leg']].append((float(row['friction']), LEVEL[row['state']]))
    if found['down']:  # the way down begins at the last value of the way up
        found['down'].append(max(found['up']))
    return [sorted(leg) for leg in found.values() if leg]


def branches(leg):
    """Both branches of a leg, in the order of growing loss."""
    low = [at for at in leg if at[0] <= MOST_LOSS]
    high = [at for at in reversed(leg) if at[0] >= MOST_LOSS]
    return low, high


def crossing(branch, is_beyond, last=False):
    """The friction between two neighbors, where a state is first beyond, or after which none falls back."""
    marks = [is_beyond(level) for _, level in branch]
    steps = [i for i in range(1, len(marks)) if marks[i] and not marks[i - 1]]
    if not steps or (last and not marks[-1]):
        return None
    index = steps[-1] if last else steps[0]
    return math.sqrt(branch[index - 1][0] * branch[index][0])


def places(folder):
    """The transitions of a ramp: line, branch, friction."""
    for side in (0, 1):
        begins, ends = [], []
        for leg in legs(folder):
            branch = branches(leg)[side]
            for line, is_beyond in (('0-1', lambda level: level >= 1), ('2-collapse', lambda level: level == 3)):
                friction = crossing(branch, is_beyond)
                if friction:
                    yield line, side, friction
            begins.append(crossing(branch, lambda level: level > 1))
            ends.append(crossing(branch, lambda level: level >= 2, last=True))
        # The loss grows with the friction on the low branch, and falls with it on the high one.
        first, last = (min, max) if side == 0 else (max, min)
        if any(begins):
            yield '1-2 (a)', side, first(filter(None, begins))
        if any(ends):
            yield '1-2 (b)', side, last(filter(None, ends))


def ramps(base, gravity):
    """The ramps of a base: inelasticity and folder."""
    own = HERE.glob(f'{base}-gravity-{gravity}-inelasticity-*-seed-1')
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


def main():
    for base in ('as-stated', 'elastic-normal', 'lossless'):
        squares, paper_squares, lines = 0.0, 0.0, 0
        for gravity in ('0.002025', '0.015625'):
            of_base = ramps(base, gravity)
            if len(of_base) < 2:
                continue
            print(f'\nbase {base}, g = {gravity}, q =', ', '.join(f'{q:g}' for q, _ in of_base))
            print('line          paper            here             points  places  error   errors of the mean')
            for line in LINES:
                at = [(q, side, energy_change(friction, q)) for q, folder in of_base
                      for name, side, friction in places(folder) if name == line]
                if not at:
                    continue
                mean, deviation = mean_and_deviation([change for _, _, change in at])
                by_place = {}
                for q, side, change in at:
                    by_place.setdefault((q, side), []).append(change)
                scatter = mean_and_deviation([sum(them) / len(them) for them in by_place.values()])[1]
                error = scatter / math.sqrt(len(by_place))
                expected, width = PAPER[gravity, line]
                away = (mean - expected) / error if len(by_place) > 1 else math.nan
                print(f'{line:11} {expected:7.3f} ± {width:.3f}  {mean:7.3f} ± {deviation:.3f} {len(at):8} {len(by_place):7}  {error:.4f} {away:7.1f}')
                if len(by_place) > 1:
                    squares, paper_squares, lines = squares + away ** 2, paper_squares + ((mean - expected) / width) ** 2, lines + 1
        if lines:
            print(f'chi square {squares:.0f} of {lines} lines, p = {tail(squares, lines):.2g}; '
                  f'rms deviation {math.sqrt(paper_squares / lines):.2f} of the paper\'s standard deviations')


if __name__ == '__main__':
    main()
