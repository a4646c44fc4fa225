"""Runs a command and writes the most memory that it had [kB] into FILE.RANK, RANK as mpirun names it.
Usage: peak_memory.py FILE COMMAND..."""

import os
import resource
import subprocess
import sys

status = subprocess.run(sys.argv[2:]).returncode
with open(f"{sys.argv[1]}.{os.environ.get('OMPI_COMM_WORLD_RANK', '0')}", "w") as file:
    print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024 // 1000, file=file)
sys.exit(status)
