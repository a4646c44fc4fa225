"""Decks and results of Scree in Python.

    import scree
    run = scree.open("results/net_400")
    run.history["energy/kinetic"]            # an array with unit and description
    run.to_dataframe("energy/*")             # pandas
    run.snapshots[-1].particles["velocity"]  # [particles][3]
    run.snapshots.at(0.5).to_pyvista()       # all of an instant, for pyvista

    deck = scree.Deck.read("input/paper/net_400.toml")
    deck["time.end"] = 0.5
    run = deck.run("results/half")
"""

from scree import clumps, packing, sweep, urdf
from scree.deck import Deck
from scree.errors import MissingError, ScreeError, ScreeWarning
from scree.history import History
from scree.quantity import Quantity
from scree.run import Run, reader
from scree.run import open_run as open
from scree.snapshots import Points, Snapshot, Snapshots

__all__ = ["Deck", "History", "MissingError", "Points", "Quantity", "Run", "ScreeError", "ScreeWarning", "Snapshot",
           "Snapshots", "clumps", "open", "packing", "reader", "sweep", "urdf"]
