#!/usr/bin/env python3
"""Has the scripts of `wakemix campaign export` run by the schedulers that this machine has: GNU parallel, HyperQueue, Slurm.

    python3 validation/scripts/campaign_schedulers.py target/release/wakemix [parallel] [hyperqueue] [slurm]

Each makes a campaign of ten short tasks; then every task must be done, and the collected table must be that of
`wakemix campaign run`. Debian: apt-get install parallel slurmctld slurmd. HyperQueue: its program `hq` on the path, or the
Python package `hyperqueue`, which has server and worker but no `hq`: then the command of the script is submitted through it.
Slurm: two daemons of one machine, without authentication, in a folder that goes away; this needs root.
"""

import contextlib
import json
import os
import re
import shlex
import shutil
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

CASE = """
name = "short"
[wind]
speed = 9.0
turbulence_intensity = 0.0
[flow]
solver = "uniform"
step = 0.2
[time]
spin_up = 5.0
duration = 20.0
[[turbine]]
name = "T1"
model = "nrel-5mw"
position_diameters = [0.0, 0.0]
structure = "rigid"
[[run]]
name = "helix"
control.T1 = { kind = "helix", sense = "ccw", amplitude_deg = 4.0, strouhal = 0.25 }
"""

CAMPAIGN = """
case = "case.toml"
collect = ["T1.*"]
[factors]
"wind.speed" = { from = 7.0, to = 11.0, step = 1.0 }
"control.T1.amplitude_deg" = [1.0, 2.0]
"""

SLURM = """
ClusterName=trial
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort=16817
SlurmdPort=16818
AuthType=auth/none
CredType=cred/none
SlurmUser=root
SlurmdUser=root
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


def main():
    program = str(Path(sys.argv[1]).resolve())
    wanted = sys.argv[2:] or ["parallel", "hyperqueue", "slurm"]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "case.toml").write_text(CASE)
        (folder / "loads.toml").write_text(CAMPAIGN)
        expected = campaign(program, folder, "run")
        run(program, "campaign", "run", expected, "-q")
        table = collected(program, expected)
        failed = False
        for scheduler in wanted:
            at = campaign(program, folder, scheduler)
            text = run(program, "campaign", "export", at, "--format", scheduler, "--chunk", "3" if scheduler == "slurm" else "1")
            script = folder / f"{scheduler}.sh"
            script.write_text(text)
            try:
                how = {"parallel": by_parallel, "hyperqueue": by_hyperqueue, "slurm": by_slurm}[scheduler](script, folder, program, at)
            except Missing as missing:
                print(f"{scheduler}: not tried: {missing}")
                continue
            status = json.loads(run(program, "campaign", "status", at, "--json"))
            is_same = status["done"] == 10 and collected(program, at) == table
            failed |= not is_same
            print(f"{scheduler}: {how}: {status['done']} of 10 tasks done, table {'the same' if is_same else 'ANOTHER'}")
    sys.exit(failed)


class Missing(Exception):
    """A scheduler is not here."""


def run(*words, **options):
    words = [str(word) for word in words]
    return subprocess.run(words, check=True, stdout=subprocess.PIPE, text=True, **options).stdout


def campaign(program, folder, name):
    run(program, "campaign", "plan", folder / "loads.toml", "-o", folder / name, "-q")
    return folder / name


def collected(program, folder):
    """The table without the wall time of each task."""
    run(program, "campaign", "collect", folder, "-o", folder / "results.csv", "-q")
    rows = [line.split(",") for line in (folder / "results.csv").read_text().splitlines()]
    time_at = rows[0].index("wall_time [s]")
    return [row[:time_at] + row[time_at + 1 :] for row in rows]


def until_done(program, folder, seconds=300):
    for _ in range(seconds):
        status = json.loads(run(program, "campaign", "status", folder, "--json"))
        if status["done"] + status["failed"] == 10:
            return
        time.sleep(1)


def by_parallel(script, folder, program, at):
    if not shutil.which("parallel"):
        raise Missing("GNU parallel is not on the path")
    subprocess.run(["bash", script], check=True, stdout=subprocess.DEVNULL)
    return run("parallel", "--version").splitlines()[0]


def by_hyperqueue(script, folder, program, at):
    if shutil.which("hq"):
        return by_hq(script, folder, program, at)
    try:
        from hyperqueue import Job, LocalCluster
        from hyperqueue.cluster import WorkerConfig
        from importlib.metadata import version
    except ImportError:
        raise Missing("neither `hq` nor the Python package hyperqueue is here")
    command = shlex.split(script.read_text(), comments=True)
    command = command[command.index("--") + 1 :]
    assert command[:2] == ["bash", "-c"], command
    with LocalCluster() as cluster:
        cluster.start_worker(WorkerConfig(cores=2))
        client = cluster.client()
        job = Job()
        # The package numbers tasks from 0, and the script from 1.
        for words in [["true"], *[command] * 10]:
            job.program(words, cwd=folder)
        client.wait_for_jobs([client.submit(job)])
    return f"HyperQueue {version('hyperqueue')} by its Python package, the script's command without `hq submit`"


def by_hq(script, folder, program, at):
    env = {**os.environ, "HQ_SERVER_DIR": str(folder / "hq")}
    with contextlib.ExitStack() as stack:
        for words in (["server", "start"], ["worker", "start", "--cpus=2"]):
            process = subprocess.Popen(["hq", *words], env=env, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            stack.callback(end, process)
            time.sleep(2)
        subprocess.run(["bash", script], check=True, env=env, cwd=folder, stdout=subprocess.DEVNULL)
        subprocess.run(["hq", "job", "wait", "all"], check=True, env=env, stdout=subprocess.DEVNULL)
    return run("hq", "--version").strip()


def end(process):
    process.terminate()
    process.wait()


def by_slurm(script, folder, program, at):
    if not (shutil.which("sbatch") and Path("/usr/sbin/slurmd").exists() and os.geteuid() == 0):
        raise Missing("slurmctld, slurmd and root are needed")
    slurm = folder / "slurm"
    for name in ("state", "spool"):
        (slurm / name).mkdir(parents=True)
    settings = SLURM.format(host=socket.gethostname(), folder=slurm, cpus=os.cpu_count())
    (slurm / "slurm.conf").write_text(settings)
    env = {**os.environ, "SLURM_CONF": str(slurm / "slurm.conf")}
    with contextlib.ExitStack() as stack:
        for daemon in ("slurmctld", "slurmd"):
            log = open(slurm / f"{daemon}.log", "w")
            process = subprocess.Popen([f"/usr/sbin/{daemon}", "-D"], env=env, stdout=log, stderr=log)
            stack.callback(end, process)
            time.sleep(3)
        subprocess.run(["sbatch", script], check=True, env=env, cwd=folder, stdout=subprocess.DEVNULL)
        until_done(program, at)
        if not any((at / "tasks").glob("*")) and json.loads(run(program, "campaign", "status", at, "--json"))["done"] == 0:
            print((slurm / "slurmctld.log").read_text()[-2000:], (slurm / "slurmd.log").read_text()[-2000:])
    array = re.search(r"--array=(\S+)", script.read_text())[1]
    return f"{run('sbatch', '--version', env=env).strip()}, array {array}"


if __name__ == "__main__":
    main()
