"""A warm Mitsuba: reads a question a line, writes an answer a line. STAGE.json MIRROR_SHARE SCALAR THREADS.

Each way of walking is run once before it is timed, so that its kernels are compiled.
"""

import json
import sys
import time

from stage import Stage


def main(stage_file, mirror_share, scalar, threads):
    import drjit

    drjit.set_thread_count(int(threads))
    with open(stage_file) as file:
        stage = Stage(json.load(file), scalar=scalar == "1", mirror_share=float(mirror_share))
    warm = set()
    for line in sys.stdin:
        question = json.loads(line)
        # A sampler's size is part of its kernel.
        way = tuple(value for key, value in question.items() if key != "seed")
        if way not in warm:
            stage.irradiance(**question)
            warm.add(way)
        cpu = time.process_time()
        (s0, s1), seconds = stage.irradiance(**question)
        cpu = time.process_time() - cpu
        answer = {"s0": s0.tolist(), "s1": s1.tolist(), "seconds": seconds, "cpu": cpu}
        print(json.dumps(answer), flush=True)


main(*sys.argv[1:])
