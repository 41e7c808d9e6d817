#!/usr/bin/env python3
"""Runs the scripts of bench/peers/ on few members and checks that they agree with the program.

Usage: tests/peers/peers_test.py PROGRAM

Exits with 77 where this interpreter has no numpy: CTest counts that as skipped.
"""

import importlib.util
import pathlib
import re
import subprocess
import sys
import unittest

PEERS = pathlib.Path(__file__).resolve().parent.parent.parent / "bench" / "peers"
PROGRAM = sys.argv.pop(1)


def run(script, *arguments, program=PROGRAM):
    command = [sys.executable, str(PEERS / script), "--program", program, "--repeat", "1", *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=False)


class NumpyUniaxial(unittest.TestCase):
    def largest_difference(self, *arguments):
        done = run("numpy_uniaxial.py", "--members", "6", "7", *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("42 members", done.stdout)
        return float(re.search(r"^largest relative difference: (\S+)$", done.stdout, re.MULTILINE)[1])

    def test_gives_the_results_of_the_sweep(self):
        self.assertLess(self.largest_difference(), 1e-9)

    def test_gives_them_in_chunks_of_any_size(self):
        self.assertLess(self.largest_difference("--chunk", "5"), 1e-9)

    def test_shows_a_quadrature_that_is_too_coarse(self):
        self.assertGreater(self.largest_difference("--nodes", "3"), 1e-9)

    def test_says_that_the_program_is_missing(self):
        done = run("numpy_uniaxial.py", program="no-such-program")
        self.assertEqual(done.returncode, 2)
        self.assertIn("there is no program no-such-program", done.stderr)


@unittest.skipUnless(importlib.util.find_spec("scipy"), "no scipy")
class SolveIvpUniaxial(unittest.TestCase):
    def errors(self, rtol):
        done = run("solve_ivp_uniaxial.py", "--rtol", rtol)
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = re.findall(r"^solve_ivp (\S+) +\S+ +\S+ +(\S+)", done.stdout, re.MULTILINE)
        self.assertEqual([method for method, _ in rows], ["RK45", "DOP853", "LSODA", "Radau"])
        return [float(error) for _, error in rows]

    def test_comes_to_the_history_of_the_program_with_the_tolerance(self):
        self.assertLess(max(self.errors("1e-10")), 1e-8)
        self.assertGreater(min(self.errors("1e-4")), 1e-6)

    def test_says_that_the_program_is_missing(self):
        done = run("solve_ivp_uniaxial.py", program="no-such-program")
        self.assertEqual(done.returncode, 2)
        self.assertIn("there is no program no-such-program", done.stderr)


if __name__ == "__main__":
    if importlib.util.find_spec("numpy") is None:
        sys.exit(77)
    unittest.main()
