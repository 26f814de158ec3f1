#!/usr/bin/env python3
"""Collisions per second of Cradle and of C. B. Mendl's hardpoint-systems in the same elastic gas on a ring.

    cmake --preset release -DCRADLE_HARDPOINT=DIR && cmake --build --preset release --target peers
    bench/peers/compare.py [COLLISIONS]

The other program's time slots are tuned first, for every number of particles: slots per particle from 1 to 8, slot
lengths by factors of two; the fastest pair is used. Then all engines run in turn, five times; medians are printed, in
millions of collisions per second. Both must have made the same number of collisions, to 1e-3: masses that differ by
1e-4 leave the gas nearly integrable.
"""

import statistics
import subprocess
import sys
from pathlib import Path

FOLDER = Path(__file__).resolve().parents[2] / "build/release/bench/peers"


def run(*words):
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, check=False)
    return done.stdout.split("\n")[:-1] if done.returncode == 0 else []


def hardpoint(particles, slots, length, collisions):
    """Collisions, time of the gas, seconds; nothing if a slot overflows."""
    lines = run(FOLDER / f"peer_hardpoint_{particles}_{slots}", length, collisions)
    if not lines:
        return None
    numbers = lines[0].split()
    return int(numbers[3]), float(numbers[4]), float(numbers[5])


def tuned(particles, collisions):
    """The fastest number of slots and slot length."""
    rates = {}
    for slots in (particles * k for k in (1, 2, 4, 8)):
        for power in range(-3, 5):
            length = 2.0**power / particles
            made = hardpoint(particles, slots, length, collisions)
            if made:
                rates[made[0] / made[2]] = slots, length
    return rates[max(rates)]


def main():
    collisions = float(sys.argv[1]) if len(sys.argv) > 1 else 1e7
    engines = ("plain", "segments", "two_threads")
    print("particles  slots  length   hardpoint  " + "  ".join(f"{engine:>11}" for engine in engines))
    for particles in (1024, 4096, 16384, 131072):
        slots, length = tuned(particles, collisions / 4)
        rates = {}
        for _ in range(5):
            made, until, seconds = hardpoint(particles, slots, length, collisions)
            rates.setdefault("hardpoint", []).append(made / seconds / 1e6)
            for line in run(FOLDER / "peer_cradle", particles, until):
                engine, own, own_seconds = line.split()
                if abs(int(own) - made) > 1e-3 * made:
                    sys.exit(f"{particles} particles to t = {until}: {made} collisions and {own}: not the same gas")
                rates.setdefault(engine, []).append(int(own) / float(own_seconds) / 1e6)
        medians = [statistics.median(rates[e]) for e in ("hardpoint", *engines)]
        print(f"{particles:9} {slots:6} {length:.1e} " + "  ".join(f"{m:11.1f}" for m in medians), flush=True)


if __name__ == "__main__":
    main()
