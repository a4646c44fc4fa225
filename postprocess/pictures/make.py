#!/usr/bin/env python3
"""Makes the pictures and films of runs in this folder from their decks.

    postprocess/pictures/make.py RESULTS [--scree SCREE] [NAME ...]     (NAME: as excavator.webp; default: all of CPUs)
    postprocess/pictures/make.py --list

Runs the decks into the folder RESULTS unless the run exists already, and writes the files into this folder. Those of
runs on a GPU are made if they are named; their results may have been thinned there (scree-post thin). All others
take one core a quarter of an hour. Needs postprocess/requirements.txt and, for paraview.png, the packages of
jobs/setup.sh --paraview. The plots in this folder are made by tests/performance/table4.py,
tests/performance/scaling_model.py and tests/verification/bulk/plots.py; calibration_soil.png is the measured.png of
`postprocess/scree-post calibrate uniaxial input/materials/soil.toml`.
"""

import argparse
import dataclasses
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
FILM = ("--frames", "25", "--rate", "8", "--width", "1000")


@dataclasses.dataclass(frozen=True)
class Picture:
    """deck: under input, without .toml; settings: of the run, as for --set; command: of scree-post, or "paraview" for
    its script; options: options of the command. folder: of the results, default: the deck's name."""

    deck: str
    command: str
    options: tuple[str, ...] = ()
    settings: tuple[str, ...] = ()
    folder: str = ""
    on_gpu: bool = False

    @property
    def results(self) -> str:
        return self.folder or self.deck.rsplit("/", 1)[-1]


# For a million particles as in the deck's head.
MILLION = ("particles.bed.count=1000000", "particles.bed.radius.min=0.00205", "particles.bed.radius.max=0.00273",
           "time.step=1.3e-5", "output.snapshot_interval=0.075", "time.end=2.6")
EXCAVATOR = ("examples/excavator", ("output.surface_fields=['pressure']",))
PICTURES = {
    "tutorial_heap.png": Picture("tutorial/2_heap", "picture"),
    "tutorial_digging.png": Picture("tutorial/4_digging", "picture"),
    "calibration_repose.png": Picture("calibration/angle_of_repose", "picture"),
    "tine_in_soil.png": Picture("examples/tine_in_soil", "picture", ("--colors", "128")),
    "bucket_of_soil.png": Picture("examples/bucket_of_soil", "picture", ("--opacity", "0.3", "--colors", "256")),
    "silo.png": Picture("examples/silo", "picture", ("--time", "1.3", "--fastest", "0.6", "--colors", "256",
                                                     "--width", "1050")),
    "screen.png": Picture("examples/screen", "picture", ("--color", "radius", "--colors", "256")),
    "chute.png": Picture("examples/chute", "picture", ("--color", "material", "--colors", "256")),
    "net_400.png": Picture("paper/net_400", "picture", settings=("time.end=0.62",)),
    "paraview.png": Picture(EXCAVATOR[0], "paraview", ("--time", "2.2", "--size", "1400", "1050"), EXCAVATOR[1]),
    "drum_lifters.webp": Picture("examples/drum_lifters", "animate", (*FILM, "--quality", "50")),
    "excavator.webp": Picture(EXCAVATOR[0], "animate", (*FILM, "--quality", "70", "--fastest", "1"), EXCAVATOR[1]),
    "excavator_million.webp": Picture(
        EXCAVATOR[0], "animate",
        (*FILM, "--from", "0.97", "--to", "2.61", "--frames", "22", "--quality", "40", "--fastest", "1"), MILLION,
        "excavator_million", on_gpu=True),
    "screw_lift.webp": Picture("examples/screw_lift", "animate", (*FILM, "--fastest", "1")),
    "wheel_rig.webp": Picture("examples/wheel_rig", "animate", (*FILM, "--fastest", "0.2")),
}


def call(*command: object) -> None:
    print(" ".join(map(str, command)), flush=True)
    subprocess.run([str(word) for word in command], check=True)


def make(name: str, results: pathlib.Path, program: pathlib.Path) -> None:
    picture = PICTURES[name]
    folder = results / picture.results
    if not (folder / "run_record.json").exists():
        settings = [word for setting in picture.settings for word in ("--set", setting)]
        call(program, "run", ROOT / f"input/{picture.deck}.toml", "--output", folder, "--overwrite", *settings,
             *(("--backend", "cuda") if picture.on_gpu else ()))
    post = ROOT / "postprocess/scree-post"
    if picture.command != "paraview":
        call(post, picture.command, folder, *picture.options, "-o", HERE / name)
        return
    call(post, "paraview", folder)
    call("xvfb-run", "-a", "pvbatch", folder / "view.py", *picture.options, "-o", HERE / name)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", nargs="?", type=pathlib.Path, metavar="RESULTS")
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--scree", type=pathlib.Path, default=ROOT / "build/release/scree", help="the program")
    parser.add_argument("--list", action="store_true", help="print how each file is made, and make none")
    arguments = parser.parse_args()
    if arguments.list:
        for name, picture in PICTURES.items():
            settings = "".join(f' --set "{setting}"' for setting in picture.settings)
            print(f"{name}: input/{picture.deck}.toml{settings}; {' '.join((picture.command, *picture.options))}")
        return 0
    if arguments.results is None:
        parser.error("the folder for the results is missing")
    for name in arguments.names:
        if name not in PICTURES:
            parser.error(f"{name}: allowed: {', '.join(PICTURES)}")
    for name in arguments.names or [name for name, picture in PICTURES.items() if not picture.on_gpu]:
        make(name, arguments.results.resolve(), arguments.scree)
    return 0


if __name__ == "__main__":
    sys.exit(main())
