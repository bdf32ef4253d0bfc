"""`diptych farm` on a real Slurm of one machine, two nodes: slurmctld, two slurmd, munged.

Usage: farm_test.py DIPTYCH. Exit code 77, with a message, where Slurm is not installed or does not start.
"""
import getpass
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import time

PROGRAM = os.path.abspath(sys.argv[1])
SKIPPED = 77
DAEMONS = ("munged", "slurmctld", "slurmd")
PICTURE = ["--size", "64x48", "--threads", "1", "--memory", "1M"]
SAMPLES = 512

CONFIGURATION = """ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
SlurmctldPort={ports[0]}
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd-%n.pid
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool-%n
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=sched_interval=1,bf_interval=1
SlurmdParameters=config_overrides
NodeName=one NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[1]} CPUs=2
NodeName=two NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[2]} CPUs=2
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def find(program):
    path = os.pathsep.join([os.environ.get("PATH", ""), "/usr/sbin", "/sbin"])
    return shutil.which(program, path=path)


def skip(why):
    print(f"skipped: {why}")
    sys.exit(SKIPPED)


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


def wait_until(condition, seconds):
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.2)
    return True


class Slurm:
    """The daemons, in a folder of their own; they end with this."""

    def __init__(self, folder):
        self.folder = folder
        self.daemons = []
        with open(os.path.join(folder, "slurm.conf"), "w", encoding="utf-8") as out:
            out.write(
                CONFIGURATION.format(
                    host=socket.gethostname().split(".")[0],
                    user=getpass.getuser(),
                    folder=folder,
                    ports=free_ports(3),
                )
            )
        os.mkdir(os.path.join(folder, "state"))
        with open(os.path.join(folder, "munge.key"), "wb") as out:
            out.write(os.urandom(128))
        os.chmod(os.path.join(folder, "munge.key"), 0o600)
        self.environment = {**os.environ, "SLURM_CONF": os.path.join(folder, "slurm.conf")}

    def start(self, *words):
        log = open(os.path.join(self.folder, f"start-{len(self.daemons)}.log"), "wb")
        self.daemons.append(
            subprocess.Popen(words, env=self.environment, stdout=log, stderr=log, stdin=subprocess.DEVNULL)
        )

    def __enter__(self):
        at = lambda name: os.path.join(self.folder, name)
        self.start(find("munged"), "--foreground", "--force", "--key-file", at("munge.key"), "--socket",
                   at("munge.socket"), "--pid-file", at("munge.pid"), "--seed-file", at("munge.seed"),
                   "--log-file", at("munge.log"))
        wait_until(lambda: os.path.exists(at("munge.socket")), 10)
        self.start(find("slurmctld"), "-D", "-c", "-f", at("slurm.conf"))
        for node in ("one", "two"):
            self.start(find("slurmd"), "-D", "-N", node, "-f", at("slurm.conf"))
        return self

    def __exit__(self, *_):
        subprocess.run(["scancel", "--quiet", "--me"], env=self.environment, check=False, capture_output=True)
        for daemon in reversed(self.daemons):
            daemon.terminate()
        for daemon in reversed(self.daemons):
            try:
                daemon.wait(10)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()

    def is_ready(self):
        text = subprocess.run(["sinfo", "--noheader", "--Node", "--format=%N %t"], env=self.environment,
                              capture_output=True, text=True, check=False).stdout
        return text.count("idle") == 2


def diptych(*words, environment=None, code=0):
    done = subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, env=environment,
                          check=False)
    assert done.returncode == code, f"{words}: {done.returncode}\n{done.stdout}{done.stderr}"
    return done.stderr


def layers_of(picture):
    """Of an OpenEXR file, by its header's list of channels; those of a display picture: its colours."""
    if not picture.endswith(".exr"):
        return {""}
    with open(picture, "rb") as file:
        header = file.read(65536)
    at = header.index(b"channels\0chlist\0") + 20
    layers = set()
    while header[at]:  # a name, then 16 bytes
        end = header.index(b"\0", at)
        name = header[at:end].decode()
        layers.add({"R": "", "G": "", "B": "", "A": "", "Z": "depth"}.get(
            name, name.rpartition(".")[0] or name))
        at = end + 17
    return layers


def expect_same(alone, together):
    """Every pixel of every layer; the files' metadata differ."""
    layers = layers_of(alone)
    assert layers == layers_of(together), f"{layers} and {layers_of(together)}"
    if alone.endswith(".exr"):
        assert {"", "depth", "normal", "object_id", "sample_count", "predicted_error"} <= layers, layers
    for layer in layers:
        diptych("compare", alone, together, "--layer", layer, "--metric", "max", "--max", "0")


def log_of(picture, what):
    """Of the last submission."""
    logs = [name.split("-") for name in os.listdir(picture + ".farm") if name.startswith("log-")]
    job = max(int(job) for _, job, kind in logs if kind == what)
    with open(os.path.join(picture + ".farm", f"log-{job}-{what}"), encoding="utf-8") as log:
        return log.read()


def farm(slurm, picture, *words, tasks=4, samples=SAMPLES):
    return [PROGRAM, "farm", *PICTURE, "--samples", str(samples), "--tasks", str(tasks), "-o", picture,
            "--folder", picture + ".farm", *words]


def start_requeued_now(slurm):
    """Slurm starts a job that was queued again after two minutes. False when none waits for that."""
    run = lambda *words: subprocess.run(words, env=slurm.environment, capture_output=True, text=True, check=False)
    waiting = [line.split()[0] for line in run("squeue", "--me", "-h", "-r", "-o", "%A %r").stdout.splitlines()
               if line.split()[1] == "BeginTime"]
    if waiting:
        time.sleep(5)  # started before the end of the first attempt has come through, the second would end with it
    for job in waiting:
        run("scontrol", "update", f"JobId={job}", "StartTime=now")
    return bool(waiting)


def a_task_is_killed_on_the_way(slurm, folder):
    picture, alone = os.path.join(folder, "killed.exr"), os.path.join(folder, "alone.exr")
    samples = 4096
    diptych("render", *PICTURE, "--samples", samples, "--quiet", "-o", alone)
    watcher = subprocess.Popen(farm(slurm, picture, "--every", "0.1s", samples=samples), env=slurm.environment,
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    slice_ = os.path.join(picture + ".farm", "slice-1.checkpoint")
    assert wait_until(lambda: os.path.exists(slice_), 120), "no checkpoint of task 1"
    victims = subprocess.run(["pgrep", "--full", f"render.*--checkpoint {slice_}"], capture_output=True,
                             text=True, check=False).stdout.split()
    programs = [pid for pid in victims if os.readlink(f"/proc/{pid}/exe") == os.path.realpath(PROGRAM)]
    assert programs, "task 1 ended before it could be killed"
    os.kill(int(programs[0]), 9)
    assert wait_until(lambda: start_requeued_now(slurm), 60), "task 1 was not queued again"
    _, said = watcher.communicate(timeout=400)
    assert watcher.returncode == 0, said
    log = log_of(picture, "1")
    assert f"going on from {slice_}" in log.partition("queued again")[2], log
    expect_same(alone, picture)


def the_picture_is_that_of_one_render(slurm, folder):
    picture, alone = os.path.join(folder, "farm.exr"), os.path.join(folder, "one.exr")
    diptych("render", *PICTURE, "--samples", SAMPLES, "--quiet", "-o", alone)
    said = diptych(*farm(slurm, picture)[1:], environment=slurm.environment)
    assert "4 tasks" in said and "100 %" in said and f"wrote {picture}" in said, said
    expect_same(alone, picture)


def flags_of_pictures_are_for_the_merging(slurm, folder):
    """Exposure and view make the PNG, and what error the EXR predicts; --half its size."""
    at = lambda name: os.path.join(folder, name)
    look = ["--exposure", "1.5", "--view", "filmic", "--half", "--16bit", "--quiet"]
    diptych("render", *PICTURE, "--samples", SAMPLES, *look, "-o", at("look.exr"), "-o", at("look.png"))
    diptych(*farm(slurm, at("far.exr"), *look, "-o", at("far.png"), tasks=3)[1:], environment=slurm.environment)
    expect_same(at("look.exr"), at("far.exr"))
    expect_same(at("look.png"), at("far.png"))


def what_cannot_be_rendered_is_told(slurm, folder):
    picture = os.path.join(folder, "bad.exr")
    scene = os.path.join(folder, "bad.gltf")
    with open(scene, "w", encoding="utf-8") as out:
        out.write("{}")
    said = diptych(*farm(slurm, picture, scene)[1:], environment=slurm.environment, code=2)
    assert "farm: task 0: " in said and "bad.gltf" in said, said

    # another submission there, in which task 0 succeeds and only task 1 has something to say
    slice_ = os.path.join(picture + ".farm", "slice-1.checkpoint")
    diptych("render", *PICTURE, "--samples", SAMPLES, "--range", "128..256", "--checkpoint", slice_, "--quiet")
    with open(slice_, "rb+") as file:
        file.seek(-1, os.SEEK_END)
        last = file.read(1)
        file.seek(-1, os.SEEK_END)
        file.write(bytes([last[0] ^ 1]))
    said = diptych(*farm(slurm, picture)[1:], environment=slurm.environment, code=2)
    assert f"farm: task 1: {slice_}: is corrupt" in said, said
    assert "--restart" not in said and f"or delete {picture}.farm" in said, said


def without_slurm():
    """Mistakes that show before anything is submitted."""
    with tempfile.TemporaryDirectory() as folder:
        nowhere = {**os.environ, "PATH": folder}
        picture = os.path.join(folder, "a.exr")
        words = ["farm", "--tasks", "2", "-o", picture]
        for more, expected in (
            ([], "no sbatch on the PATH"),
            (["--samples", "16"], "ask for at most 1 tasks"),
            (["--range", "0..16"], "the tasks' own"),
            (["--no-such-flag"], "--no-such-flag"),
            (["--16bit"], "--16bit: of .png and .tif"),
            (["--view", "cinema"], "cinema"),
            (["--exposure", "1000"], "--exposure 1000: out of range"),
            (["--share", "90"], "give --samples"),
            (["--refresh", "1s"], "--refresh"),
            (["--capture", "a.json"], "--capture"),
            (["--every", "soon"], "--every soon: not a time"),
            (["--bounces", "few"], "--bounces few"),
            (["--eye", "1,2,3"], "--eye and --target"),
            (["--memory", "lots"], "--memory lots"),
            (["--backend", "abacus"], "--backend abacus: no such backend"),
            (["--solo", "node"], "only for a scene's file"),
            (["nowhere.gltf"], "nowhere.gltf: no such file"),
        ):
            said = diptych(*words, *more, environment=nowhere, code=2)
            assert expected in said and said.count("\n") == 1, f"{more}: {said}"
        assert os.listdir(folder) == []

        shared = picture + ".farm"
        os.mkdir(shared)
        diptych("render", *PICTURE, "--samples", 64, "--range", "0..32", "--quiet",
                "--checkpoint", os.path.join(shared, "slice-0.checkpoint"))
        words = ["farm", *PICTURE, "--samples", "64", "-o", picture]
        for more, expected in (
            (["--tasks", "2"], "no sbatch on the PATH"),  # it would go on from there
            (["--tasks", "2", "--seed", "2"], "differ in seed (1 and 2); name another folder with --folder, or "),
            (["--tasks", "2", "--bounces", "1"], f"or delete {shared} to begin anew"),
            (["--tasks", "4"], "holds samples 0..32, more than up to 16; name another folder"),
        ):
            said = diptych(*words, *more, environment=nowhere, code=2)
            assert expected in said and "--restart" not in said, f"{more}: {said}"


def main():
    without_slurm()
    missing = [name for name in (*DAEMONS, "sbatch", "scontrol") if not find(name)]
    if missing:
        skip(f"no {', '.join(missing)} here (packages slurm-wlm and munge)")
    with tempfile.TemporaryDirectory(prefix="diptych-farm-") as folder:
        os.chmod(folder, 0o755)
        with Slurm(folder) as slurm:
            if not wait_until(slurm.is_ready, 60):
                with open(os.path.join(folder, "start-1.log"), encoding="utf-8") as log:
                    skip(f"Slurm does not start here: {log.read()[-300:]}")
            for case in (the_picture_is_that_of_one_render, flags_of_pictures_are_for_the_merging,
                         a_task_is_killed_on_the_way, what_cannot_be_rendered_is_told):
                begin = time.monotonic()
                case(slurm, folder)
                print(f"{case.__name__}: ok, {time.monotonic() - begin:.0f} s", flush=True)


if __name__ == "__main__":
    main()
