"""Import of robots from URDF.

    deck = scree.urdf.to_deck("robot.urdf", scree.urdf.Options(positions={"elbow": 0.5}))
    deck.write("robot.toml")
"""

from scree.urdf.convert import Options, to_deck

__all__ = ["Options", "to_deck"]
