"""An agent learns to explore all small worlds, and loses against the certificate.

    python python/examples/learn.py

Monte Carlo control with a table. The state is the folded trail, as the robot sees it: all that its walk
proves. The value of a door is the mean number of moves from there to the end of the episodes so far, without
detours: if an episode came back to a state, what lies between proved nothing.
"""

import random
from collections import defaultdict

import toposlam as ts
from toposlam.gym import ExplorationEnv

EDGES = 3
ROUNDS = 100
EXPLORES = 0.2  # the part of doors that are chosen at random
RATE = 0.02  # the least weight of the last episode


class Agent:
    def __init__(self, seed=1):
        self.random = random.Random(seed)
        self.moves_left = defaultdict(dict)
        self.visits = defaultdict(int)

    def choose(self, info, explores):
        """The best door that was tried. If none was, or else sometimes, a door at random."""
        doors, known = range(info["action_mask"].sum()), self.moves_left[info["form"]]
        if not known or self.random.random() < explores:
            return self.random.choice(doors)
        return min(known, key=known.get)

    def explore(self, env, world, explores=0.0):
        """An episode in a world. The agent learns if it explores. Returns the number of moves."""
        _, info = env.reset(options={"world": world})
        way, ended = {}, False
        while not ended:
            state = info["form"]
            if state in way:  # a detour
                states = list(way)
                way = {state: way[state] for state in states[: states.index(state)]}
            way[state] = self.choose(info, explores)
            _, _, terminated, truncated, info = env.step(way[state])
            ended = terminated or truncated
        if explores and terminated:
            for left, (state, door) in enumerate(reversed(way.items()), start=1):
                self.visits[state, door] += 1
                before = self.moves_left[state].get(door, 0)
                rate = max(1 / self.visits[state, door], RATE)
                self.moves_left[state][door] = before + rate * (left - before)
        return info["moves"]


def main():
    env, agent = ExplorationEnv(EDGES), Agent()
    worlds = list(ts.starts(EDGES))
    certificates = sum(len(world.certificate()) for world in worlds)
    print(f"certificates: {certificates} moves from all {len(worlds)} starts")
    for when in ["at random", "learned"]:
        moves = sum(agent.explore(env, world) for world in worlds)
        print(f"{when + ':':<13} {moves} moves, {moves / certificates:.3f} times the certificates")
        if when == "at random":
            for _ in range(ROUNDS):
                agent.random.shuffle(worlds)
                for world in worlds:
                    agent.explore(env, world, EXPLORES)


if __name__ == "__main__":
    main()
