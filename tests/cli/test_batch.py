"""The program as batch systems and terminals meet it: signals before the first step, progress lines.
Usage: SCREE=path/to/scree python3 test_batch.py"""

import fcntl
import os
import pty
import re
import signal
import struct
import subprocess
import termios
import unittest

from test_cli import DECK, ENVIRONMENT, LIMIT, SCREE, STOPPED, CommandLineTest

COLUMNS = 60  # of the terminal
# Time, percent, time left, steps, step, contacts, rate, balance.
PROGRESS = (r"(?m)^t = (\S+) of 0\.4 s \(\d+ %\), \d+ s left, \d+ steps, h = 1\.00e-04 s, \d+ contacts, "
            r"\S+ particle-steps/s, balance \S+$")


class EarlySignalTest(CommandLineTest):
    def test_a_signal_before_the_first_step_ends_the_run_with_a_message(self):
        fifo = self.folder / "fifo.toml"
        os.mkfifo(fifo)
        for number in (signal.SIGTERM, signal.SIGINT, signal.SIGUSR1):
            with self.subTest(signal=number.name):
                run = subprocess.Popen([SCREE, "run", str(fifo), "--output", str(self.folder / "out")], text=True,
                                       env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
                self.addCleanup(run.kill)
                with open(fifo, "w") as deck:  # waits for the run, which then waits for its deck
                    run.send_signal(number)
                    deck.write(DECK + '[integrator]\nparticles = "hht"\n')  # nothing is chosen, and told
                text, _ = run.communicate(timeout=LIMIT)
                self.assertEqual(run.returncode, STOPPED, text)
                self.assertEqual(text, f"stopped by signal ({signal.strsignal(number)}) before the first step, "
                                       "without a new checkpoint\n")
                self.assertFalse((self.folder / "out").exists())


class ProgressTest(CommandLineTest):
    def text_on_terminal(self, own):
        """What a run prints on a terminal: its own, or, as under mpirun, one that another process made for it."""
        ours, theirs = pty.openpty()
        fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, COLUMNS, 0, 0))
        run = subprocess.Popen([SCREE, "run", str(self.deck), "--output", str(self.folder / "out"), "--overwrite"],
                               env=ENVIRONMENT, stdin=theirs, stdout=theirs, stderr=theirs, start_new_session=True,
                               preexec_fn=(lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0)) if own else None)
        self.addCleanup(run.kill)
        os.close(theirs)
        text = b""
        try:
            while piece := os.read(ours, 4096):
                text += piece
        except OSError:  # the last one has closed it
            pass
        os.close(ours)
        self.assertEqual(run.wait(LIMIT), 0, text)
        return text.decode().replace("\r\n", "\n")

    def test_progress_is_one_line_on_a_terminal_and_a_line_per_tenth_of_the_run_elsewhere(self):
        in_place = self.text_on_terminal(True)
        self.assertGreaterEqual(in_place.count("\rt = "), 10)
        self.assertNotIn("\nt = 0.2000 of", in_place)
        shown = re.findall(r"\r(t = .*?)\x1b\[K", in_place)
        self.assertEqual({len(line) for line in shown}, {COLUMNS - 1})  # one that wraps could not be rewritten
        piped = self.run_deck(0, "out").stdout
        for text in (self.text_on_terminal(False), piped):
            self.assertNotIn("\r", text)
            times = [float(found) for found in re.findall(PROGRESS, text)]
            self.assertEqual([int(time / 0.04 + 1e-6) for time in times], list(range(1, 11)))


if __name__ == "__main__":
    unittest.main()
