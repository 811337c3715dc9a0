"""Runs one command with limits of time and memory, and says how it ended and what it took."""
import ctypes
import os
import signal
import subprocess
import time

PR_SET_PDEATHSIG = 1
POLL_SECONDS = 0.05
LIBC = ctypes.CDLL(None)


def die_with_parent():
    """In the child: a killed parent leaves no command behind."""
    LIBC.prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


def resident_bytes(group):
    """Resident memory of all processes of a process group now."""
    total, page = 0, os.sysconf("SC_PAGE_SIZE")
    for entry in os.listdir("/proc"):
        if not entry.isdigit():
            continue
        try:
            with open(f"/proc/{entry}/stat", encoding="ascii", errors="replace") as file:
                fields = file.read().rpartition(")")[2].split()
        except OSError:  # it ended meanwhile
            continue
        if int(fields[2]) == group:
            total += int(fields[21]) * page
    return total


def kill_group(process):
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass


def run_limited(arguments, seconds, memory_bytes, log, cwd=None):
    """Dictionary with status (done, timeout, memory, missing), exit_code (negative: a signal), seconds, cpu_seconds
    (of the command and what it waited for; a busy machine changes them little), peak_memory_bytes. Standard output
    and error go to the file `log`. The limit of memory holds for the whole process group: its resident memory is
    sampled, and the kernel's high-water mark of the largest decides after."""
    start = time.monotonic()
    with open(log, "wb") as output:
        try:
            process = subprocess.Popen(  # pylint: disable=subprocess-popen-preexec-fn,consider-using-with
                arguments, cwd=cwd, stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT,
                start_new_session=True, preexec_fn=die_with_parent)
        except OSError as error:
            output.write(f"{arguments[0]}: {error.strerror}\n".encode())
            return {"status": "missing", "exit_code": None, "seconds": 0.0, "cpu_seconds": 0.0,
                    "peak_memory_bytes": 0}
    status, peak = "done", 0
    try:
        while True:
            pid, code, usage = os.wait4(process.pid, os.WNOHANG)
            if pid:
                break
            peak = max(peak, resident_bytes(process.pid))
            if peak > memory_bytes:
                status = "memory"
            elif time.monotonic() - start > seconds:
                status = "timeout"
            if status != "done":
                kill_group(process)
                _, code, usage = os.wait4(process.pid, 0)
                break
            time.sleep(POLL_SECONDS)
    finally:
        kill_group(process)  # what it left in the background
    process.returncode = os.waitstatus_to_exitcode(code)
    peak = max(peak, usage.ru_maxrss * 1024)
    if status == "done" and peak > memory_bytes:
        status = "memory"
    return {"status": status, "exit_code": process.returncode, "seconds": time.monotonic() - start,
            "cpu_seconds": usage.ru_utime + usage.ru_stime, "peak_memory_bytes": peak}
