#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""same_bits.py PROGRAM: the state hashes that PROGRAM prints are the same for any number of threads."""
import os
import subprocess
import sys


def hashes(program, threads):
    environment = dict(os.environ, OMP_NUM_THREADS=str(threads), OMP_PROC_BIND="false", OMP_WAIT_POLICY="passive")
    run = subprocess.run([program, "[state_hashes]"], env=environment, capture_output=True, text=True)
    if run.returncode != 0:
        sys.exit(f"same_bits: {program} failed with {threads} threads:\n{run.stdout}{run.stderr}")
    return [line for line in run.stdout.splitlines() if line.startswith("hash ")]


reference = hashes(sys.argv[1], 1)
if len(reference) != 15 or len(set(reference)) != 15:  # 3 of the particle kernels, 12 of cell lanes
    sys.exit(f"same_bits: expected fifteen different hashes, got {reference}")
for threads in (1, 2, 3, 4, 8):
    found = hashes(sys.argv[1], threads)
    if found != reference:
        sys.exit(f"same_bits: {threads} threads give {found}, one thread gave {reference}")
print("same_bits: the same hashes with 1, 2, 3, 4 and 8 threads:", *reference)
