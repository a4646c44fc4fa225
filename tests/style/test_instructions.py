"""Products are summed up one by one in the program's own code, but where it says otherwise (src/base/fused.hpp): no
instruction that fuses products side by side, of which gcc 12 makes some whatever -ffp-contract says. With one, a CPU's
own build would not have the bits of a GPU. Usage: test_instructions.py PROGRAM"""

import re
import shutil
import subprocess
import sys

FUSED_SIDE_BY_SIDE = re.compile(r"\tvfm(?:addsub|subadd)\w+")


def main():
    objdump = shutil.which("objdump")
    if objdump is None:
        sys.exit("objdump of binutils must be on the PATH")
    program = subprocess.run([objdump, "-d", "--no-show-raw-insn", sys.argv[1]], capture_output=True, text=True,
                             check=True).stdout
    found = len(FUSED_SIDE_BY_SIDE.findall(program))
    instructions = program.count("\n")
    print(f"{found} of {instructions} lines fuse products side by side")
    return 1 if found or instructions < 10000 else 0


if __name__ == "__main__":
    sys.exit(main())
