#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A foot-bot learns to drive among boxes, by the cross-entropy method, with numpy alone.

usage: avoid.py [ZIGGURAT] [--worlds N] [--generations N] [--plot CURVE.svg]

A policy is a layer of 16 weights and 2 offsets: from eight sectors of proximity sensors to two wheels. Each
generation tries policies drawn from a normal distribution, one in each world, and moves the distribution to those
that did best. A policy is rewarded in each tick for speed, if it drives straight and near nothing.
"""

import argparse
import pathlib
import time

import numpy as np

import ziggurat
from ziggurat.spaces import Box

SCENE = pathlib.Path(__file__).with_name("avoid.argos")
SECTORS, SPEED, TICKS = 8, 0.3, 200  # of sensors; [m/s]; of an episode
POLICIES, BEST = 32, 8  # of a generation


def sectors(robot):
    """The nearest thing in each eighth of the circle: 0 (nothing) to 1 (contact)."""
    return np.reshape(robot.proximity, (SECTORS, -1)).max(axis=1)


def drive(robot, action):
    robot.wheels.set_velocity(*(SPEED * np.clip(action, -1, 1)))
    robot.action = np.clip(action, -1, 1)  # for the reward


def reward(robot):
    left, right = robot.action
    return (left + right) / 2 * (1 - np.sqrt(abs(left - right) / 2)) * (1 - max(robot.proximity))


def act(weights, observations):
    """Of each world its own policy."""
    matrix = weights[:, :2 * SECTORS].reshape(-1, 2, SECTORS)
    return np.tanh(np.einsum("wij,wj->wi", matrix, observations) + weights[:, 2 * SECTORS:])


def returns(env, policies):
    """The mean reward of each policy over an episode."""
    found = []
    for batch in policies.reshape(-1, env.num_envs, policies.shape[1]):
        observations, _ = env.reset(seed=[1] * env.num_envs)  # all policies in the same world
        total = np.zeros(env.num_envs)
        for _ in range(TICKS):
            observations, rewards, *_ = env.step(act(batch, observations))
            total += rewards
        found.append(total / TICKS)
    return np.concatenate(found)


def learn(env, generations):
    random = np.random.default_rng(1)
    mean, deviation = np.zeros(2 * SECTORS + 2), np.ones(2 * SECTORS + 2)
    for generation in range(generations):
        policies = mean + deviation * random.normal(size=(POLICIES, len(mean)))
        found = returns(env, policies)
        best = policies[np.argsort(found)[-BEST:]]
        mean, deviation = best.mean(axis=0), best.std(axis=0) + 0.3 / (generation + 1)
        yield found


def plot(curve, path):
    """Mean and best return by generation, in SVG."""
    width, height, left, bottom = 520, 300, 50, 40
    x = lambda i: left + i / max(1, len(curve) - 1) * (width - left - 20)
    top = 1.05 * max(found.max() for found in curve)
    low = min(0, min(found.mean() for found in curve))
    y = lambda v: height - bottom - (v - low) / (top - low) * (height - bottom - 20)
    line = lambda values: " ".join(f"{x(i):.1f},{y(v):.1f}" for i, v in enumerate(values))
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" '
           'font-size="13"><rect width="100%" height="100%" fill="white"/>']
    for number in range(5):
        value = low + number / 4 * (top - low)
        out.append(f'<path d="M{left} {y(value):.1f}H{width - 20}" stroke="#ddd"/>'
                   f'<text x="{left - 6}" y="{y(value) + 4:.1f}" text-anchor="end">{value:.2f}</text>')
    for color, name, values, row in [("#b30000", "best", [f.max() for f in curve], 0),
                                     ("#386cb0", "mean", [f.mean() for f in curve], 1)]:
        out.append(f'<polyline points="{line(values)}" fill="none" stroke="{color}" stroke-width="2"/>'
                   f'<text x="{left + 12}" y="{30 + 18 * row}" fill="{color}">{name} of {POLICIES} policies</text>')
    out.append(f'<text x="{(left + width) / 2:.0f}" y="{height - 12}" text-anchor="middle">generation</text></svg>\n')
    pathlib.Path(path).write_text("\n".join(out))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("ziggurat", nargs="?", default="ziggurat")
    parser.add_argument("--worlds", type=int, default=4, choices=[1, 2, 4, 8, 16, 32])
    parser.add_argument("--generations", type=int, default=15)
    parser.add_argument("--plot")
    options = parser.parse_args()
    begin, curve = time.monotonic(), []
    with ziggurat.vector_env(SCENE, options.worlds, command=options.ziggurat, observe=sectors, act=drive,
                             action_space=Box(-1, 1, (2,)), reward=reward) as env:
        for found in learn(env, options.generations):
            curve.append(found)
            print(f"generation {len(curve):2}: mean {found.mean():6.3f}, best {found.max():6.3f}, "
                  f"{time.monotonic() - begin:5.1f} s", flush=True)
    if options.plot:
        plot(curve, options.plot)


if __name__ == "__main__":
    main()
