# SPDX-License-Identifier: Zlib
# Copyright (c) 2026 The BulletFEM authors
"""pybullet's Panda grasps a soft ball of 70 mm and 80 g with 8 N a finger, lifts and holds it: panda.py <output>.

Writes, as JSON: how high it lifts the ball [m], by how much the ball slips in the hand meanwhile [m], the ball's extent
in the end over that at rest, and the processor time of a step [ms]."""
import json
import sys
import time

import numpy as np
import pybullet as p
import pybullet_data

STEP = 1 / 240  # [s]
RADIUS, MASS = 0.035, 0.08  # of the ball [m], [kg]
SHEAR_MODULUS, LAMBDA = 2e4, 4e4  # [Pa]
FORCE = 8  # of a finger [N]
HAND = 11  # link between the finger tips
FINGERS = (9, 10)
HOME = (0, 0.3, 0, -2.2, 0, 2.5, 0.785)  # of the arm's joints [rad]
DOWN = p.getQuaternionFromEuler([np.pi, 0, 0])


def build():
    """The Panda with its open hand around the ball on the ground."""
    p.connect(p.DIRECT)
    p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.setGravity(0, 0, -9.81)
    p.setTimeStep(STEP)
    p.loadURDF("plane.urdf")
    panda = p.loadURDF("franka_panda/panda.urdf", useFixedBase=True)
    for joint, angle in enumerate(HOME):
        p.resetJointState(panda, joint, angle)
    for _ in range(20):  # the result of one call is the start of the next
        for joint, angle in enumerate(angles_of(panda, RADIUS)):
            p.resetJointState(panda, joint, angle)
    for finger in FINGERS:
        p.resetJointState(panda, finger, 0.04)
        p.changeDynamics(panda, finger, lateralFriction=1)
    both = p.createConstraint(panda, FINGERS[0], panda, FINGERS[1], p.JOINT_GEAR, [1, 0, 0], [0, 0, 0], [0, 0, 0])
    p.changeConstraint(both, gearRatio=-1, erp=0.1, maxForce=50)  # the fingers move alike
    ball = p.loadSoftBody("ball.vtk", simFileName="ball.vtk", basePosition=[0.5, 0, RADIUS + 0.001], scale=RADIUS, mass=MASS,
                          useNeoHookean=1, NeoHookeanMu=SHEAR_MODULUS, NeoHookeanLambda=LAMBDA, NeoHookeanDamping=0.01,
                          collisionMargin=0.001, frictionCoeff=1)
    return panda, ball


def angles_of(panda, height):
    """Angles of the arm's joints with the hand at this height [m] above the ball's place."""
    return p.calculateInverseKinematics(panda, HAND, [0.5, 0, height], DOWN, maxNumIterations=50)[:7]


def nodes(ball):
    return np.array(p.getMeshData(ball, -1, flags=p.MESH_DATA_SIMULATION_MESH)[1])


def move(panda, heights):
    """A step for each height of the hand, with closing fingers; the times of the steps [s]."""
    times = []
    for height in heights:
        p.setJointMotorControlArray(panda, range(7), p.POSITION_CONTROL, targetPositions=angles_of(panda, height), forces=[200] * 7)
        p.setJointMotorControlArray(panda, FINGERS, p.POSITION_CONTROL, targetPositions=[0, 0], forces=[FORCE] * 2)
        start = time.process_time()
        p.stepSimulation()
        times.append(time.process_time() - start)
    return times


def in_hand(panda, ball):
    """Place of the ball between the finger tips [m]."""
    tips = np.mean([p.getLinkState(panda, finger)[0] for finger in FINGERS], axis=0)
    return nodes(ball).mean(axis=0) - tips


def main(output):
    panda, ball = build()
    rest = np.ptp(nodes(ball), axis=0)
    times = move(panda, np.full(240, RADIUS))
    before, low = in_hand(panda, ball), nodes(ball)[:, 2].mean()
    times += move(panda, np.linspace(RADIUS, RADIUS + 0.2, 240))
    times += move(panda, np.full(480, RADIUS + 0.2))
    points = nodes(ball)
    result = {"lifted": points[:, 2].mean() - low, "slip": float(np.linalg.norm(in_hand(panda, ball) - before)),
              "extent": (np.ptp(points, axis=0) / rest).tolist(), "milliseconds": 1000 * float(np.median(times))}
    with open(output, "w") as file:
        json.dump(result, file)
    print(result)


if __name__ == "__main__":
    main(sys.argv[1])
