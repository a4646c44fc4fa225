"""Parts of a deck that the file of a robot does not contain."""

HEAD = """\
# Made from a URDF. Frames of bodies are the frames of its links, and joint coordinates are those of the URDF, so that
# limits and positions have the same meaning. Data that a URDF does not contain are here and, as comments, at the end.
title = ""
gravity = [0.0, 0.0, -9.80665]

[space]                             # contains the stretched robot
dimension = 3
min = [0.0, 0.0, 0.0]
max = [0.0, 0.0, 0.0]
leaving = "ballistic"

[time]
end = 1.0                           # adaptive steps; with many particles see input/choosing.md

[output]
snapshot_interval = 0.02
history_interval = 0.01

[[materials]]
name = "robot"

[[contact.pairs]]                   # no contact between parts of the robot
materials = ["robot", "robot"]
stiffness = 0.0
"""

TAIL = """
# A joint that closes a loop, between the frames of two links. The markers must coincide at t = 0; set initial joint
# coordinates by scree-post urdf --position JOINT=VALUE. In a loop of revolute joints about parallel axes use a
# point-on-line, with z of the first marker along these axes: a further revolute joint would be redundant. In other
# loops use a spherical joint, for example.
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

# Particles, and their contacts with each other and the robot:
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
