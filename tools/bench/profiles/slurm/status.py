#!/usr/bin/env python3
"""Tells Snakemake how a Slurm job is doing: running, success or failed. Needs no accounting database.

A job that Slurm itself puts back in the queue (a machine died) is running. One that Slurm has forgotten, MinJobAge
after its end, counts as failed: the engine then runs it again.
"""
import re
import subprocess
import sys
import time

ACTIVE = {"PENDING", "RUNNING", "COMPLETING", "CONFIGURING", "SUSPENDED", "REQUEUED", "REQUEUE_HOLD", "RESIZING",
          "SIGNALING", "STAGE_OUT", "STOPPED"}
ATTEMPTS = 5  # a controller that is busy or starts again


def main():
    job = sys.argv[1].split(";")[0]
    for attempt in range(ATTEMPTS):
        asked = subprocess.run(["scontrol", "--oneliner", "show", "job", job], check=False, text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        state = re.search(r"\bJobState=(\w+)", asked.stdout)
        if state:
            found = state.group(1)
            print("success" if found == "COMPLETED" else "running" if found in ACTIVE else "failed")
            return
        if "Invalid job id" in asked.stderr:
            break
        time.sleep(2 ** attempt)
    print("failed")


if __name__ == "__main__":
    main()
