"""The microscope's data of a run: its collisions and its initial state, or its snapshots, small enough for a page.

The page draws world lines of particles, which are straight between collisions, at depths that neither positions nor
times resolve. So its data define each gap exactly: which particles collide, the interval since the previous collision,
the closing speed, the kind of the collision, and the gaps at the start. The rest follows by sums near the view.

Arrays are typed, bytes of equal weight are stored together, and all is deflated: {"type", "length", "deflate"}.
Up to `FULL_COLLISIONS` collisions every bit is kept; with more, intervals and closing speeds keep 24 bits of mantissa.
"""
import base64
import zlib

import numpy as np

FULL_COLLISIONS = 400_000
MOST_COLLISIONS = 1_200_000
LEAST = 1e-290  # of speeds, in l/t

# What a page needs besides the data, in this order.
SCRIPTS = tuple(f"microscope{name}.js" for name in ("_world", "_gaps", "_chart", "_camera", "_view", "_overview",
                                                    "_hands", ""))


def data(result):
    """The microscope's data of a run, as a dict for JSON; None if it has neither events nor two snapshots."""
    scene = result.scene
    if result.kind != "run" or not {"law", "initial"} <= set(scene) or scene["initial"].get("type") == "clusters":
        return None
    law = {"type": result.law} | {key: result.setting("law", key) for key in ("restitution", "loss")
                                  if key in scene["law"]}
    # World lines between collisions follow from constant restitutions, without walls, and are straight without gravity.
    follows = "cutoff_exponent" not in scene["law"] and not {"walls", "gravity"} & set(scene)
    found = collisions(result) if follows and len(result.events.get("kind", ())) else snapshots(result)
    return found and {"law": law} | found


def collisions(result):
    """The collisions of a run and its initial state."""
    events, initial = result.events, result.table("initial")
    total = len(events.left)
    left, right, kind, interval, speed = (events[name][:MOST_COLLISIONS]
                                          for name in ("left", "right", "kind", "interval", "closing_speed"))
    # Late collisions of runs with more digits, which doubles cannot represent, are left out too.
    lost = (speed < LEAST) | ((interval > 0) & (interval * speed < LEAST * 1e-10))
    count = max(1, int(np.argmax(lost))) if lost.any() else len(speed)
    left, right, kind, interval, speed = (column[:count] for column in (left, right, kind, interval, speed))
    held, particles, length = int(initial.index[0]), len(initial.index), initial.circumference
    # The particles that have collided, and the next one on each side.
    first = 0 if length else max(held, int(min(left.min(), right.min())) - 1)
    end = particles if length else min(held + particles, int(max(left.max(), right.max())) + 2)
    x, v, mass, gap = (initial[name][first - held:end - held] for name in ("x", "v", "m", "gap"))
    left, right = (column.astype(np.int64) - first for column in (left, right))
    beside = np.where(left + 1 < particles, left + 1, 0) if length else left + 1
    particle_type = np.uint16 if end - first <= 1 << 16 else np.uint32
    reached = result.outcome == "reached the end" and count == total
    bits = 52 if count <= FULL_COLLISIONS else 24
    return {
        "kind": "collisions", "start": result.setting("run", "start", 0), "first": first, "length": length,
        "end": result.setting("run", "until") if reached else None, "collisions": count, "total": total,
        "digits": int(bits * 0.30103), "collapse": bool(result.collapse),
        "x": pack(x), "v": pack(v), "gap": pack(np.nan_to_num(gap)), "mass": None if np.all(mass == 1) else pack(mass),
        "left": pack(left.astype(particle_type)),
        "right": None if np.array_equal(right, beside) else pack(right.astype(particle_type)),
        "interval": pack(interval, bits), "speed": pack(speed, bits),
        "event": pack(kind.astype(np.uint8)) if kind.any() else None}


def snapshots(result):
    """The particles at each snapshot: gaps and closing speeds, position and velocity of the first one."""
    found = []
    for shot in result.snapshots:
        particles = len(shot.x)
        if particles < 2:
            continue
        index, mass = shot.index.values, shot.m.values
        in_a_row = np.array_equal(index, index[0] + np.arange(particles, dtype=index.dtype))
        found.append({
            "time": shot.time, "particles": particles, "first": int(index[0]), "x": float(shot.x[0]),
            "v": float(shot.v[0]), "index": None if in_a_row else pack(index.astype(np.uint32)),
            "mass": None if np.all(mass == 1) else pack(mass), "gap": pack(shot.gap[:particles - 1], 32),
            "speed": pack(shot.closing_speed[:particles - 1], 32)})
    return {"kind": "snapshots", "snapshots": found} if len(found) > 1 else None


def pack(array, bits=52):
    """A typed array as text; mantissas of float64 are rounded to the given number of bits (52 keeps all)."""
    array = np.ascontiguousarray(array)
    if array.dtype == np.float64 and bits < 52:
        spare = np.uint64(52 - bits)
        rounded = array.view(np.uint64) + (np.uint64(1) << (spare - np.uint64(1)))
        array = (rounded >> spare << spare).view(np.float64)
    planes = array.view(np.uint8).reshape(len(array), array.itemsize).T.tobytes() if len(array) else b""
    return {"type": array.dtype.str[1:], "length": len(array),
            "deflate": base64.b64encode(zlib.compress(planes, 6)).decode("ascii")}
