"""What the microscope shows of a run: its collisions and its initial state, or its snapshots, small enough for a page.

The page draws world lines of particles, which are straight between collisions, at depths that neither positions nor
times resolve. So it gets what defines a gap exactly: who meets whom, the interval to the collision before, the closing
speed, and the gaps at the start. Everything else follows from these by sums near the place in view.

Arrays are typed, byte planes of equal weight stand together, and the whole is deflated: {"type", "length", "deflate"}.
Up to `FULL_COLLISIONS` collisions every bit is kept. Beyond, intervals keep 40 bits of mantissa; closing speeds, which
the law gives again from the initial velocities, are left out where that is so to `SPEED_ERROR`, and else keep 24 bits
as intervals do then.
"""
import base64
import zlib

import numpy as np

FULL_COLLISIONS = 400_000
MOST_COLLISIONS = 1_200_000
SPEED_ERROR = 1e-7
LEAST = 1e-290  # of speeds, in l/t


def data(result):
    """What the microscope needs of a run, as a dict for JSON; None where there are neither events nor two snapshots.

    result: `.file`, an open h5py.File, and `.scene`, the effective scene as nested dicts.
    """
    file, scene = result.file, result.scene
    if "kind" in file.attrs or not {"law", "initial"} <= set(scene):
        return None
    found = {"version": 1, "name": _text(file.attrs.get("name", "")), "title": str(scene.get("title", "")),
             "law": _law(scene)}
    if scene["initial"].get("type") == "clusters":
        return None
    # World lines between collisions follow from constant restitutions, and between particles, not walls.
    follows = "cutoff_exponent" not in scene["law"] and "walls" not in scene
    if follows and "initial" in file and len(file["events/left"]) > 0:
        return found | _collisions(file, scene)
    if len(file.get("snapshots", ())) > 1:
        snapshots = _snapshots(file)
        return found | snapshots if snapshots else None
    return None


def _collisions(file, scene):
    """The collisions of a run and the state it started from."""
    events, total = file["events"], len(file["events/left"])
    count = min(total, MOST_COLLISIONS)
    left, right = (events[name][:count].astype(np.int64) for name in ("left", "right"))
    interval, speed = events["interval"][:count], events["closing_speed"][:count]
    # What doubles cannot hold any longer, late in a collapse of more digits, is left out too.
    lost = (speed < LEAST) | ((interval > 0) & (interval * speed < LEAST * 1e-10))
    if lost.any():
        count = max(1, int(np.argmax(lost)))
        left, right, interval, speed = (column[:count] for column in (left, right, interval, speed))
    initial = file["initial"]
    start = {name: initial[name][:] for name in ("x", "v", "m", "gap")}
    held, particles = int(initial["index"][0]), len(initial["index"])
    length = float(initial.attrs["circumference"])
    # Particles that have met somebody, and the next one on each side.
    first = 0 if length else max(held, int(min(left.min(), right.min())) - 1)
    end = particles if length else min(held + particles, int(max(left.max(), right.max())) + 2)
    part = slice(first - held, end - held)
    start = {name: column[part] for name, column in start.items()}
    left, right = left - first, right - first
    kind = _kinds(scene, left, right, events["time"][:count], events["time_low"][:count], speed)
    digits, keep_speed = 52, True
    if count > FULL_COLLISIONS:
        keep_speed = not _speeds_follow(scene, start, left, right, speed, kind)
        digits = 24 if keep_speed else 40
    beside = np.where(left + 1 < particles, left + 1, 0) if length else left + 1
    particle_type = np.uint16 if end - first <= 1 << 16 else np.uint32
    reached = _text(file.attrs.get("outcome", "")) == "reached the end" and count == total
    collapse = file["collapse"].attrs if "collapse" in file else None
    return {
        "kind": "collisions", "start": _number(scene["run"].get("start", 0)), "first": first, "length": length,
        "end": _number(scene["run"]["until"]) if reached else None, "collisions": count, "total": total,
        "digits": int(digits * 0.30103),
        "collapse": None if collapse is None else {"time": float(collapse["time"])},
        "x": pack(start["x"]), "v": pack(start["v"]), "gap": pack(np.nan_to_num(start["gap"])),
        "mass": None if np.all(start["m"] == 1) else pack(start["m"]),
        "left": pack(left.astype(particle_type)),
        "right": None if np.array_equal(right, beside) else pack(right.astype(particle_type)),
        "interval": pack(interval, digits), "speed": pack(speed, digits) if keep_speed else None,
        "event": pack(kind) if kind.any() else None}


def _snapshots(file):
    """The particles at each snapshot: gaps and closing speeds, place and velocity of the first one."""
    found = []
    for name in sorted(file["snapshots"]):
        group = file["snapshots"][name]
        if len(group["x"]) < 2:
            continue
        index, mass, gap, speed = (group[key][:] for key in ("index", "m", "gap", "closing_speed"))
        particles = len(index)
        in_a_row = np.array_equal(index, index[0] + np.arange(particles, dtype=index.dtype))
        found.append({
            "time": float(group.attrs["time"]), "particles": particles, "first": int(index[0]),
            "index": None if in_a_row else pack(index.astype(np.uint32)),
            "x": float(group["x"][0]), "v": float(group["v"][0]),
            "mass": None if np.all(mass == 1) else pack(mass),
            "gap": pack(gap[:particles - 1], 32), "speed": pack(speed[:particles - 1], 32)})
    return {"kind": "snapshots", "snapshots": found} if len(found) > 1 else None


def pack(array, digits=52):
    """A typed array as text; of the mantissas of float64 so many bits, rounded to nearest, 52 being all."""
    array = np.ascontiguousarray(array)
    if array.dtype == np.float64 and digits < 52:
        spare = np.uint64(52 - digits)
        bits = array.view(np.uint64) + (np.uint64(1) << (spare - np.uint64(1)))
        array = (bits >> spare << spare).view(np.float64)
    planes = array.view(np.uint8).reshape(len(array), array.itemsize).T.tobytes() if len(array) else b""
    return {"type": array.dtype.str[1:], "length": len(array),
            "deflate": base64.b64encode(zlib.compress(planes, 6)).decode("ascii")}


def unpack(packed):
    """The array of which `pack` made a text."""
    kind = np.dtype("<" + packed["type"])
    planes = np.frombuffer(zlib.decompress(base64.b64decode(packed["deflate"])), np.uint8)
    return planes.reshape(kind.itemsize, packed["length"]).T.copy().view(kind).ravel()


# The law


def _law(scene):
    law = scene["law"]
    found = {"type": law["type"]}
    for key in ("restitution", "loss"):
        if key in law:
            found[key] = _number(law[key])
    return found


def _kinds(scene, left, right, time, time_low, speed):
    """Of each collision 0: by the law, 1: elastic, 2: merge. Wet collisions are 0: their masses decide."""
    law, run = scene["law"], scene.get("run", {})
    kind = np.zeros(len(left), np.uint8)
    if law["type"] == "sticky":
        kind[:] = 2
    if law["type"] == "inelastic":
        kind[speed < _number(law.get("cutoff", 0))] = 1
        if run.get("collapse") == "contact-time":
            kind[~(_rest(left, right, time, time_low) > _number(run["contact_time"]))] = 1
        if run.get("collapse") == "merge":
            kind[speed < _number(run["merge_speed"])] = 2
    return kind


def _rest(left, right, time, time_low):
    """Time since the last collision that one of the two particles had; infinite where there was none."""
    count = len(left)
    particle, collision = np.concatenate((left, right)), np.tile(np.arange(count), 2)
    order = np.lexsort((collision, particle))
    particle, collision = particle[order], collision[order]
    since = np.full(2 * count, np.inf)
    same = particle[1:] == particle[:-1]
    now, before = collision[1:][same], collision[:-1][same]
    since[1:][same] = (time[now] - time[before]) + (time_low[now] - time_low[before])
    rest = np.full(count, np.inf)
    np.minimum.at(rest, collision, since)
    return rest


def _speeds_follow(scene, start, left, right, speed, kind):
    """Whether initial velocities and the law give every closing speed again; only where all masses are equal."""
    if scene["law"]["type"] != "inelastic" or np.any(start["m"] != 1) or np.any(kind == 2):
        return False
    restitution = np.where(kind == 1, 1.0, _number(scene["law"]["restitution"]))
    kick = (1 + restitution) * speed / 2
    count = len(left)
    particle, collision = np.concatenate((left, right)), np.tile(np.arange(count), 2)
    side = np.concatenate((np.zeros(count, np.int8), np.ones(count, np.int8)))
    order = np.lexsort((collision, particle))
    particle, collision, side = particle[order], collision[order], side[order]
    gained = np.where(side == 0, -kick[collision], kick[collision])
    so_far = np.cumsum(gained) - gained
    begins = np.concatenate(([0], np.flatnonzero(particle[1:] != particle[:-1]) + 1))
    so_far -= np.repeat(so_far[begins], np.diff(np.append(begins, len(particle))))
    velocity = np.empty((2, count))
    velocity[side, collision] = start["v"][particle] + so_far
    return bool(np.all(np.abs(velocity[0] - velocity[1] - speed) <= SPEED_ERROR * speed))


def _number(value):
    return float(value)


def _text(value):
    return value.decode() if isinstance(value, bytes) else str(value)


# What a page needs beside the data, in this order.
SCRIPTS = ("microscope_world.js", "microscope_gaps.js", "microscope_chart.js", "microscope_camera.js",
           "microscope_view.js", "microscope_overview.js", "microscope_hands.js", "microscope.js")
STYLES = ("microscope.css",)
