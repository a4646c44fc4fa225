"""Calibration: four tests of the grains of a materials file, their measured angles and strengths, and the search for two
parameters that give wished values (scree-post calibrate; input/calibration/README.md).

`scaling` gives a deck another size of grains, `materials` puts the grains of a file into a deck, `surface` finds the
angle of a free surface, `tests` has the four tests, `runs` carries them out, `search` varies parameters, `plots` draws."""
