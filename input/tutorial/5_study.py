"""Tutorial 5: a parameter study of the drum of tutorial 3.

    5_study.py list LIST            writes the list of its runs
    5_study.py table LIST RESULTS   prints a table of their results"""

import sys

import numpy as np
import scree


def torque(run):
    """Mean torque of the motor over the second half of the run [N m]."""
    late = run.history.time > run.history.time[-1] / 2
    return round(np.mean(run.history["efforts/motor/effort"][late]), 2)


if sys.argv[1] == "list":
    runs = scree.sweep.write_list(sys.argv[2], "input/tutorial/3_drum.toml", {"motors.motor.rate": [1.0, 2.0, 4.0]})
    print(f"{runs} runs")
else:
    print(scree.sweep.table(sys.argv[2], sys.argv[3], {"torque": torque}).to_string())
