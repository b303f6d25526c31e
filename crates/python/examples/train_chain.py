"""Trains the gains of a chain of seven by an evolution strategy, in NumPy alone.

python crates/python/examples/train_chain.py [--generations 40] [--films folder]

The policy is the paper's output feedback law (eq 42); what is trained are its six gains K, β and κ, of distance and bearing, the
same for all followers. It begins at the paper's gains, which are the baseline. Antithetic evolution strategies (Salimans et al.,
2017, arXiv:1703.03864) move the logarithms of the gains by what random neighbours are rewarded. Every candidate drives the chain
from the same random starts, all candidates side by side in one vector environment. Starts that training has never seen decide
whether the result is better.
"""

import argparse
import pathlib
import time

import echelon
import numpy as np
from echelon.envs import FormationVectorEnv, LawPolicy, Scatter, Task, output_feedback

NAMES = ("k", "beta", "slope")
# Gains of the paper's simulations: K, β and κ, each for distance and bearing.
PAPER = np.array([5.0, 5.0, 5.0, 5.0, 24.53, 24.53])
PAIRS, STARTS, TESTS = 8, 4, 64
# Standard deviation of a candidate's logarithms, and of the step that they are moved by.
SPREAD, RATE = 0.15, 0.3
# Seeds of the starts that decide; training draws its own below.
UNSEEN = 2**40


def chain():
    """A leader on a circle and six followers in line."""
    robots = [{"name": "leader", "pose": [0, 0, 0], "path": {"kind": "circle", "speed": 1.0, "turn_rate": 0.3}}]
    for place in range(1, 7):
        ahead = f"follower-{place - 1}" if place > 1 else "leader"
        robots.append({"name": f"follower-{place}", "leader": ahead, "distance": 1.0, "bearing": "180 deg",
                       "pose": [-1.2 * place, 0, 0]})
    time = {"duration": 10.0, "period": 0.02}
    return echelon.Scene.load({"schema": 1, "title": "A chain of seven", "time": time, "robots": robots})


def law(scene, gains):
    """The law with gains of the shape (6,) or (copies · followers, 6)."""
    return output_feedback(scene, **{name: gains[..., 2 * i:2 * i + 2] for i, name in enumerate(NAMES)})


def returns(envs, scene, gains, seeds):
    """Returns of one episode of every copy; gains are of the shape (6,) or (copies, 6)."""
    if gains.ndim == 2:
        gains = np.repeat(gains, len(envs.followers), axis=0)
    policy = LawPolicy(law(scene, gains), envs)
    observations, _ = envs.reset(seed=seeds)
    total, truncated = np.zeros(envs.num_envs), np.zeros(1, dtype=bool)
    while not truncated.all():
        observations, rewards, _, truncated, _ = envs.step(policy(observations))
        total += rewards
    return total


def train(scene, task, generations, random, tell=print):
    """The gains after training, and what the middle of the search was rewarded on the way."""
    envs = FormationVectorEnv(scene, task, 2 * PAIRS * STARTS)
    middle = np.log(PAPER)
    for generation in range(generations):
        steps = random.standard_normal((PAIRS, len(PAPER)))
        candidates = np.exp(middle + SPREAD * np.concatenate((steps, -steps)))
        seeds = np.tile(random.integers(UNSEEN, size=STARTS), 2 * PAIRS).tolist()
        score = returns(envs, scene, np.repeat(candidates, STARTS, axis=0), seeds).reshape(2 * PAIRS, STARTS).mean(axis=1)
        # Ranks from −1 to 1 in place of rewards: a crash counts no more than the last place.
        rank = 2 * score.argsort().argsort() / (2 * PAIRS - 1) - 1
        middle += RATE / PAIRS * ((rank[:PAIRS] - rank[PAIRS:])[:, None] * steps).sum(axis=0)
        if generation % 10 == 0 or generation == generations - 1:
            tell(f"generation {generation:3}: mean return {score.mean():8.3f}")
    return np.exp(middle)


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--generations", type=int, default=40)
    arguments.add_argument("--tests", type=int, default=TESTS, help="unseen starts that decide")
    arguments.add_argument("--seed", type=int, default=0)
    arguments.add_argument("--films", type=pathlib.Path, help="folder for films of before and after")
    given = arguments.parse_args()

    scene, task = chain(), Task(scatter=Scatter(position=0.3, heading=0.3), end_on_contact=False)
    tests = FormationVectorEnv(scene, task, given.tests)
    unseen = [UNSEEN + test for test in range(given.tests)]
    begun = time.perf_counter()
    trained = train(scene, task, given.generations, np.random.default_rng(given.seed))
    print(f"trained in {time.perf_counter() - begun:.0f} s")
    before, after = (returns(tests, scene, gains, unseen) for gains in (PAPER, trained))
    gained = after - before
    for name, gains, result in (("before", PAPER, before), ("after", trained, after)):
        shown = ", ".join(f"{gain:.2f}" for gain in gains)
        print(f"{name:6}: return {result.mean():7.3f} on {given.tests} unseen starts, gains {shown}")
    print(f"gained {gained.mean():.3f} ± {gained.std(ddof=1) / np.sqrt(given.tests):.3f}, "
          f"better from {(gained > 0).sum()} of {given.tests} starts")
    if given.films:
        given.films.mkdir(parents=True, exist_ok=True)
        for name, gains in (("before", PAPER), ("after", trained)):
            print(scene.film(given.films / f"{name}.mp4", size=(640, 360), law=law(scene, gains), fresh=True))


if __name__ == "__main__":
    main()
