"""A disk that runs full and a user who interrupts: the old output stays, no temporary file does."""
import os
import resource
import signal
import subprocess
import time

from program import COARSE, HAS_VTU, OLD, PROGRAM, ProgramCase, obj_text, sphere

# In the order in which the program writes them.
OUTPUTS = ("out.obj",) + (("out.vtu",) if HAS_VTU else ()) + ("out.json",)


def remesh_arguments():
    arguments = ["remesh", "holed.obj", "-o", "out.obj", "--json", "out.json", "--quiet", *COARSE]
    return arguments + (["--vtu", "out.vtu"] if HAS_VTU else [])


class FullDisk(ProgramCase):
    def sizes(self):
        self.succeed(*remesh_arguments())
        return {name: os.path.getsize(self.path(name)) for name in OUTPUTS}

    def assert_stopped_at(self, failing, run):
        self.assert_one_line(run, 6, r"\Acellocut: " + failing.replace(".", r"\.") + ": cannot write: ")
        for name in OUTPUTS[OUTPUTS.index(failing):]:
            self.assertEqual(self.get(name), OLD, name)
        for name in OUTPUTS[:OUTPUTS.index(failing)]:  # whole, since each was written before
            self.assertNotEqual(self.get(name), OLD, name)
        self.assertEqual(self.names(), sorted(["holed.obj", *OUTPUTS]))

    def test_short_write_at_each_output(self):
        sizes = self.sizes()
        before = 0
        for failing in OUTPUTS:
            for share in (0, 0.5):  # no room for it at all, or for a part of it
                with self.subTest(failing=failing, share=share):
                    for name in OUTPUTS:
                        self.put(name, OLD)
                    limit = before + int(share * sizes[failing])
                    run = self.run_program(
                        *remesh_arguments(), env=self.shimmed(CELLOCUT_TEST_WRITE_LIMIT=str(limit)))
                    self.assert_stopped_at(failing, run)
            before += sizes[failing]

    def test_file_size_limit_at_each_output(self):
        self.sizes()
        targets = [("-o", "out.obj"), ("--json", "out.json")]
        if HAS_VTU:
            targets.append(("--vtu", "out.vtu"))

        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))

        for ignored in (False, True):
            def prepare(ignored=ignored):
                limit()
                signal.signal(signal.SIGXFSZ, signal.SIG_IGN if ignored else signal.SIG_DFL)

            for option, failing in targets:
                with self.subTest(failing=failing, ignored=ignored):
                    self.put(failing, OLD)
                    # /dev/null has room for a surface that is not the one under test.
                    others = [] if option == "-o" else ["-o", "/dev/null", "--output-format", "obj"]
                    run = self.run_program("remesh", "holed.obj", "--quiet", *COARSE, option, failing,
                                           *others, preexec_fn=prepare)
                    self.assert_one_line(run, 6, r"\Acellocut: " + failing + ": cannot write: File too large")
                    self.assertEqual(self.get(failing), OLD)
                    self.assertEqual(self.names(), sorted(["holed.obj", *OUTPUTS]))

    def test_report_of_check(self):
        self.fail_with(6, r"\Acellocut: out\.json: cannot write: No space left", "check", "holed.obj",
                       "--json", "out.json", outputs=("out.json",),
                       env=self.shimmed(CELLOCUT_TEST_WRITE_LIMIT="100"))

    def test_named_pipe_gets_the_whole_and_no_more(self):
        self.succeed("remesh", "holed.obj", "-o", "file.obj", "--quiet", *COARSE)
        os.mkfifo(self.path("pipe"))
        with subprocess.Popen(["cat", "pipe"], cwd=self.folder, stdout=subprocess.PIPE) as reader:
            self.succeed("remesh", "holed.obj", "-o", "pipe", "--output-format", "obj", "--quiet", *COARSE)
            self.assertEqual(reader.communicate(timeout=60)[0], self.get("file.obj"))

    def test_full_device(self):
        self.fail_with(6, r"\Acellocut: /dev/full: cannot write: No space left", "remesh", "holed.obj",
                       "-o", "/dev/full", "--output-format", "obj", "--quiet", *COARSE)

    def test_full_standard_output(self):
        for command in (("check", "out.obj"), ("list",)):
            with self.subTest(command):
                self.succeed("remesh", "holed.obj", "-o", "out.obj", "--quiet", *COARSE)
                with open("/dev/full", "wb") as full:
                    run = subprocess.run([PROGRAM, *command], cwd=self.folder, stdout=full, stderr=subprocess.PIPE,
                                         timeout=300, check=False)
                self.assertEqual((run.returncode, run.stderr), (6, b"cellocut: standard output: cannot be written\n"))

    def test_reader_that_has_had_enough(self):
        read, write = os.pipe()
        os.close(read)
        run = subprocess.run([PROGRAM, "list"], stdout=write, stderr=subprocess.PIPE, timeout=300, check=False)
        os.close(write)
        self.assertEqual((run.returncode, run.stderr), (0, b""))

    def test_empty_solid_and_no_room(self):
        self.put("out.json", OLD)
        run = self.run_program("remesh", "holed.obj", "-o", "out.obj", "--no-unary", "--surface", "sdf", *COARSE, "--json",
                               "out.json", env=self.shimmed(CELLOCUT_TEST_WRITE_LIMIT="100"))
        self.assert_one_line(run, 6, r"\Acellocut: out\.json: cannot write: No space left")
        self.assertEqual(self.get("out.json"), OLD)
        self.assertEqual(self.names(), ["holed.obj", "out.json"])

    def test_writes_that_take_little_at_a_time(self):
        self.sizes()
        wanted = [self.get(name) for name in OUTPUTS[:-1]]
        for name in OUTPUTS:
            self.put(name, OLD)
        self.succeed(*remesh_arguments(), env=self.shimmed(CELLOCUT_TEST_WRITE_SHORT="1"))
        self.assertEqual([self.get(name) for name in OUTPUTS[:-1]], wanted)
        self.assertEqual(self.get("out.json")[-2:], b"}\n")
        self.assertEqual(self.names(), sorted(["holed.obj", *OUTPUTS]))


class Interruption(ProgramCase):
    def start(self, *arguments, **how):
        # The test may itself run where the signal is ignored; the program must not inherit that.
        def attend():
            signal.signal(signal.SIGINT, signal.SIG_DFL)

        return subprocess.Popen([PROGRAM, *arguments], cwd=self.folder, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, preexec_fn=attend, **how)

    def finish(self, running):
        out, errors = running.communicate(timeout=120)
        self.assertEqual(out, b"")
        return errors.decode().splitlines()

    def interrupt_in(self, stage, number):
        """Sends a signal when the line of a stage appears; the lines that come after it."""
        self.put("sphere.obj", obj_text(sphere(24)))
        for name in OUTPUTS:
            self.put(name, OLD)
        arguments = remesh_arguments()
        arguments[arguments.index("--quiet")] = "--verbose"
        arguments[1] = "sphere.obj"
        arguments[arguments.index("16")] = "256"
        running = self.start(*arguments)
        for line in running.stderr:
            if line == b"cellocut: " + stage + b"\n":
                break
        running.send_signal(number)
        lines = self.finish(running)
        self.assertEqual(running.returncode, 130, lines)
        for name in OUTPUTS:
            self.assertEqual(self.get(name), OLD, name)
        self.assertEqual(self.names(), sorted(["holed.obj", "sphere.obj", *OUTPUTS]))
        # The stage may have been over before the signal came; nothing but the one line is said besides.
        said = [line for line in lines if line.startswith("cellocut: sphere.obj: ")]
        self.assertEqual(said, ["cellocut: sphere.obj: interrupted"], lines)
        self.assertEqual(lines[-1], said[0])

    def test_interrupt_in_the_field(self):
        self.interrupt_in(b"field", signal.SIGINT)

    def test_interrupt_in_the_decimation(self):
        self.interrupt_in(b"decimation", signal.SIGINT)

    def test_termination(self):
        self.interrupt_in(b"iso-surface", signal.SIGTERM)

    def test_second_interrupt_ends_a_run_that_waits(self):
        self.put("out.obj", OLD)
        running = self.start("remesh", "-", "--format", "obj", "-o", "out.obj", "--verbose", *COARSE,
                             stdin=subprocess.PIPE)
        self.assertEqual(running.stderr.readline(), b"cellocut: read\n")
        deadline = time.monotonic() + 60
        while running.poll() is None and time.monotonic() < deadline:
            running.send_signal(signal.SIGINT)
            time.sleep(0.05)
        if running.poll() is None:
            running.kill()
            self.fail("still running after many interrupts")
        self.finish(running)
        self.assertEqual(running.returncode, 130)
        self.assertEqual(self.get("out.obj"), OLD)
        self.assertEqual(self.names(), ["holed.obj", "out.obj"])
