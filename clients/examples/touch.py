#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A tool from palpate.idl alone, in Python, with Cyclone DDS and its default QoS.

Finds the organ, presses its top 3 mm deep within a second, and prints the largest force.

    pip install cyclonedds
    idlc -l py palpate.idl          # makes the package palpate beside this file
    python3 touch.py [DOMAIN]
"""
import math
import sys
import time

from cyclonedds.domain import DomainParticipant
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic

from palpate import ServerStatus, SurfaceMesh, ToolForce, ToolPose

SERVER_RUNNING = 1  # palpate.idl
DEPTH = 0.003  # m
POSES = 1000  # one per ms


def wait_for(reader, kind, wanted):
    """The first `kind` that `wanted` accepts; exits when none came within 10 s."""
    for _ in range(1000):
        for sample in reader.take(N=16):
            if isinstance(sample, kind) and wanted(sample):
                return sample
        time.sleep(0.01)
    sys.exit(f"no {kind.__name__} within 10 s")


def top_of(mesh):
    """The accessible node with the largest z."""
    nodes = [mesh.positions[3 * i:3 * i + 3] for i, accessible in enumerate(mesh.accessible) if accessible]
    return max(nodes, key=lambda X: X[2])


def press(poses, forces, status, top):
    """Presses and returns the largest force, and how many answers came."""
    first_seq = time.monotonic_ns()  # a sender that starts again stays ahead of its former poses
    largest, answers = 0.0, 0
    for i in range(POSES):
        height = 0.001 - (0.001 + DEPTH) * i / POSES  # of the tip's lowest point over the top
        poses.write(ToolPose(
            server_id=status.server_id, tool_id=0, seq=first_seq + i, stamp_ns=time.monotonic_ns(),
            position=[top[0], top[1], top[2] + status.tip_radius[0] + height], orientation=[0.0, 0.0, 0.0, 1.0],
            buttons=0, has_velocity=False, velocity=[0.0, 0.0, 0.0]))
        for force in forces.take(N=16):
            if not isinstance(force, ToolForce):
                continue  # a writer has left
            if force.session == status.session and force.tool_id == 0 and force.pose_seq >= first_seq:
                answers += 1
                largest = max(largest, math.hypot(*force.force))
        time.sleep(0.001)
    return largest, answers


def main():
    participant = DomainParticipant(int(sys.argv[1]) if len(sys.argv) > 1 else 0)
    statuses = DataReader(participant, Topic(participant, "palpate/server/status", ServerStatus))
    surfaces = DataReader(participant, Topic(participant, "palpate/organ/surface", SurfaceMesh))
    poses = DataWriter(participant, Topic(participant, "palpate/tool/measured_cp", ToolPose))
    forces = DataReader(participant, Topic(participant, "palpate/tool/servo_cf", ToolForce))
    status = wait_for(statuses, ServerStatus, lambda s: s.state == SERVER_RUNNING)
    mesh = wait_for(surfaces, SurfaceMesh, lambda m: m.session == status.session)
    largest, answers = press(poses, forces, status, top_of(mesh))
    print(f"largest force {largest:.3f} N, {answers} answers to {POSES} poses")


if __name__ == "__main__":
    main()
