"""Results of Scree in Python.

    import scree
    run = scree.open("results/net_400")
    run.history["energy/kinetic"]            # an array with unit and description
    run.to_dataframe("energy/*")             # pandas
    run.snapshots[-1].particles["velocity"]  # [particles][3]
    run.snapshots.at(0.5).to_pyvista()       # all of an instant, for pyvista
"""

from scree import sweep
from scree.errors import ScreeError
from scree.history import History
from scree.quantity import Quantity
from scree.run import Run
from scree.run import open_run as open
from scree.snapshots import Points, Snapshot, Snapshots

__all__ = ["History", "Points", "Quantity", "Run", "ScreeError", "Snapshot", "Snapshots", "open", "sweep"]
