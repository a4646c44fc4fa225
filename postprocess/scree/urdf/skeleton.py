"""What a deck needs and a robot's file does not say."""

HEAD = """\
# Made from a URDF. The frames of bodies are those of its links, and the coordinates of joints are its own, so that
# limits and positions mean the same. What it does not say stands here and, as comments, at the end.
title = ""
gravity = [0.0, 0.0, -9.80665]

[space]                             # has room for the robot, stretched out
dimension = 3
min = [0.0, 0.0, 0.0]
max = [0.0, 0.0, 0.0]
leaving = "drift"

[time]
end = 1.0                           # steps are chosen by their error; with many particles see input/choosing.md

[output]
snapshot_interval = 0.02
history_interval = 0.01

[[materials]]
name = "robot"

[[contact.pairs]]                   # the parts of the robot do not touch each other
materials = ["robot", "robot"]
stiffness = 0.0
"""

TAIL = """
# A joint that closes a loop, between the frames of two links. The markers must meet at t = 0; scree-post urdf starts
# the robot there with --position JOINT=VALUE. Of hinges about parallel axes the last one is a point-on-line, whose
# first marker's z is along these axes: one more hinge would say again what the others say. Others are spherical, say.
# [[markers]]
# name = "loop_parent"
# body = "ground"
# local_point = [0.0, 0.0, 0.0]
# [[markers]]
# name = "loop_child"
# body = "{body}"
# local_point = [0.0, 0.0, 0.0]
# [[joints]]
# name = "loop"
# type = "point-on-line"
# markers = ["loop_parent", "loop_child"]

# A drive:
# [[motors]]
# name = "motor"
# joint = "{joint}"
# type = "effort"
# effort = 1.0

# Particles, and how they touch each other and the robot:
# [[materials]]
# name = "grains"
# [[contact.pairs]]
# materials = ["grains", "grains"]
# stiffness = 1e5
# restitution = 0.5
# [[contact.pairs]]
# materials = ["grains", "robot"]
# stiffness = 1e5
# restitution = 0.5
# [[particles]]
# name = "grains"
# kind = "random"
# material = "grains"
# count = 100
# min = {low}
# max = {high}
# radius = {radius}
# density = 2500.0
"""
