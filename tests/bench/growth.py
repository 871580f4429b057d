#!/usr/bin/env python3
"""How the time of a whole exploration grows with the map and with the team: log-log slopes.

    tests/bench/growth.py [--outrider build/outrider] [--cells 500,1000,2000] [--robots 4,8,16,32,64]

Explores offices of growing size (datasets/make_large_office.py) with eight robots, and one office with growing teams, disc
sensing, to 95 %, and prints CPU seconds, memory, messages a robot, time of a decision and the slopes. CPU time, so other
work on the machine matters little; a quarter of an hour all in all.
"""
import argparse
import json
import math
import os
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
MAKE_OFFICE = os.path.join(HERE, "..", "..", "datasets", "make_large_office.py")


def run(outrider, world, robots, coordinator):
    command = [outrider, "explore", world, "--robots", str(robots), "--coordinator", coordinator, "--until", "0.95", "--json"]
    with tempfile.TemporaryFile("w+") as out:
        process = subprocess.Popen(command, stdout=out, stderr=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        if os.waitstatus_to_exitcode(status) not in (0, 1):
            sys.exit(f"failed: {' '.join(command)}")
        out.seek(0)
        text = out.read()
    record = json.loads(text)
    result = record["result"]
    return {"cpu_s": usage.ru_utime + usage.ru_stime, "mb": usage.ru_maxrss / 1024, "time_s": result["time_s"], "status": result["status"],
            "messages": result["messages"]["sent"] / robots, "decision_ms": record["timing"]["decision_ms"]}


def slope(points):
    """Least squares of log y over log x."""
    logs = [(math.log(x), math.log(y)) for x, y in points]
    mx, my = sum(x for x, _ in logs) / len(logs), sum(y for _, y in logs) / len(logs)
    return sum((x - mx) * (y - my) for x, y in logs) / sum((x - mx) ** 2 for x, _ in logs)


def row(label, r, robots):
    print(f"{label:>12} {r['cpu_s']:8.2f} s {r['mb']:8.0f} MB {r['time_s']:8.1f} s simulated {r['messages']:8.0f} messages a robot"
          f" ({r['messages'] / r['time_s']:.1f} a second), decision p50 {r['decision_ms']['p50']:.3f} p95 {r['decision_ms']['p95']:.2f} ms,"
          f" {r['status']}", flush=True)


def main():
    numbers = lambda text: [int(n) for n in text.split(",")]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--outrider", default=os.path.join(HERE, "..", "..", "build", "outrider"))
    parser.add_argument("--coordinator", default="daa")
    parser.add_argument("--cells", type=numbers, default=[500, 1000, 2000], help="edges of the maps")
    parser.add_argument("--robots", type=numbers, default=[4, 8, 16, 32, 64], help="sizes of the team")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        world = lambda edge: os.path.join(folder, f"office-{edge}.yaml")
        for edge in {*arguments.cells, 1000}:
            subprocess.run([sys.executable, MAKE_OFFICE, str(edge), folder], check=True)
        print("cells, 8 robots")
        points = []
        for edge in arguments.cells:
            r = run(arguments.outrider, world(edge), 8, arguments.coordinator)
            points.append((edge * edge, r["cpu_s"]))
            row(f"{edge}^2", r, 8)
        if len(points) > 1:
            print(f"slope in cells {slope(points):.2f}")
        print("robots, 1000 x 1000 cells")
        points = []
        for robots in arguments.robots:
            r = run(arguments.outrider, world(1000), robots, arguments.coordinator)
            points.append((robots, r["cpu_s"]))
            row(robots, r, robots)
        if len(points) > 1:
            print(f"slope in robots {slope(points):.2f}")


if __name__ == "__main__":
    main()
