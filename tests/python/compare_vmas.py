"""Agent-steps a second beside VMAS, the vectorised multi-agent simulator in PyTorch.

python tests/python/compare_vmas.py [--pairs 5] [--counts 1,16,256,4096]

It needs echelon[envs] and vmas (with torch for the processor) in one environment. Both simulate seven agents with a time step of
0.1 s under random actions, look for contacts, and return observations, rewards and endings of all copies: VMAS its scene
`navigation`, in which agents observe others by lidar, Echelon seven followers behind a leader that turns, who are told the
truth. VMAS is also measured without lidar and collisions. Each side runs in a process of its own. They take turns, and medians
count.
"""

import argparse
import os
import statistics
import subprocess
import sys
import time

AGENTS = 7
STEP = 0.1
# Time that one measurement takes, s, and steps of it at least.
BUDGET, LEAST = 1.0, 3
# Sets of random actions, made before the clock runs.
ACTIONS = 4
SIDES = ("vmas", "vmas bare", "echelon")


def scene():
    """A leader on a circle and seven followers in two files."""
    robots = [{"name": "leader", "pose": [0, 0, 0], "path": {"kind": "circle", "speed": 1.0, "turn_rate": 0.1}}]
    for place in range(AGENTS):
        leader = "leader" if place < 2 else f"follower-{place - 2}"
        side, row = -1 if place % 2 else 1, 1 + place // 2
        robots.append({"name": f"follower-{place}", "leader": leader, "distance": 1.5,
                       "bearing": f"{side * (135 if place < 2 else 180)} deg",
                       "pose": [-1.5 * row, 1.1 * side, 0], "law": {"kind": "robust-state"}})
    return {"schema": 1, "title": "Seven agents", "time": {"duration": 1e4, "period": STEP}, "robots": robots}


def echelon_steps(count):
    import numpy as np
    from echelon.envs import FormationVectorEnv, Task

    envs = FormationVectorEnv(scene(), Task(end_on_contact=False), count)
    envs.reset(seed=0)
    random = np.random.default_rng(0)
    actions = [random.uniform(-1, 1, envs.action_space.shape).astype(np.float32) for _ in range(ACTIONS)]
    return lambda step: envs.step(actions[step % ACTIONS])


def vmas_steps(count, **options):
    import torch
    import vmas

    env = vmas.make_env(scenario="navigation", num_envs=count, device="cpu", continuous_actions=True, n_agents=AGENTS,
                        seed=0, **options)
    env.reset()
    actions = [[torch.rand(count, 2) * 2 - 1 for _ in env.agents] for _ in range(ACTIONS)]
    return lambda step: env.step(actions[step % ACTIONS])


def work(side):
    """Answers every count on standard input by the seconds of a step."""
    known = {}
    for line in sys.stdin:
        count = int(line)
        if count not in known:
            known.clear()
            make = {"echelon": echelon_steps, "vmas": vmas_steps,
                    "vmas bare": lambda count: vmas_steps(count, collisions=False)}[side]
            known[count] = make(count)
            known[count](0)
        begun, steps = time.perf_counter(), 0
        while steps < LEAST or time.perf_counter() - begun < BUDGET:
            known[count](steps)
            steps += 1
        print((time.perf_counter() - begun) / steps, flush=True)


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--pairs", type=int, default=5, help="measurements of each side")
    arguments.add_argument("--counts", default="1,16,64,256,1024,4096", help="numbers of copies, with commas between them")
    arguments.add_argument("--work", help=argparse.SUPPRESS)
    given = arguments.parse_args()
    if given.work:
        return work(given.work)
    workers = {
        side: subprocess.Popen([sys.executable, __file__, "--work", side], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                               stderr=subprocess.DEVNULL, text=True)
        for side in SIDES
    }
    print(f"{os.cpu_count()} processors; agent-steps a second, medians of {given.pairs}")
    print("| copies | VMAS navigation | without lidar and collisions | Echelon | times VMAS |")
    print("|---:|---:|---:|---:|---:|")
    for count in map(int, given.counts.split(",")):
        seconds = {side: [] for side in SIDES}
        for _ in range(given.pairs):
            for side, worker in workers.items():
                worker.stdin.write(f"{count}\n")
                worker.stdin.flush()
                seconds[side].append(float(worker.stdout.readline()))
        vmas, bare, own = (AGENTS * count / statistics.median(seconds[side]) for side in SIDES)
        print(f"| {count} | {vmas:,.0f} | {bare:,.0f} | {own:,.0f} | {own / vmas:.1f} |", flush=True)
    for worker in workers.values():
        worker.stdin.close()
        worker.wait()
    return 0


if __name__ == "__main__":
    sys.exit(main())
