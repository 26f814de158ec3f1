"""What the microscope shows of a run: its contacts and its initial state, or its snapshots, small enough for a page.

The page draws world lines of bodies, which are straight between contacts, at depths that neither positions nor times
resolve. So it gets what defines a gap exactly: who meets whom, the interval to the contact before, the closing speed,
and the gaps at the start. Everything else follows from these by sums near the place that is looked at.

Arrays are typed, byte planes of equal weight stand together, and the whole is deflated: {"type", "length", "deflate"}.
Up to `FULL_CONTACTS` contacts every bit is kept. Beyond, intervals keep 40 bits of mantissa; closing speeds, which the
law gives again from the initial velocities, are left out where that is so to `SPEED_ERROR`, and else keep 24 bits as
intervals do then.
"""
import base64
import zlib

import numpy as np

FULL_CONTACTS = 400_000
MOST_CONTACTS = 1_200_000
SPEED_ERROR = 1e-7
LEAST = 1e-290  # of speeds, in l/t
UNIT = 2.0 ** -28  # of the spacing: what displacements are counted in


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
    if "events" in file and len(file["events/left"]) > 0:
        return found | _contacts(file, scene)
    if len(file.get("snapshots", ())) > 1:
        snapshots = _snapshots(file)
        return found | snapshots if snapshots else None
    return None


def _contacts(file, scene):
    """The contacts of a run and the state it started from."""
    events, total = file["events"], len(file["events/left"])
    count = min(total, MOST_CONTACTS)
    left, right = (events[name][:count].astype(np.int64) for name in ("left", "right"))
    interval, speed = events["interval"][:count], events["closing_speed"][:count]
    # What doubles cannot hold any longer, late in a collapse of more digits, is left out too.
    lost = (speed < LEAST) | ((interval > 0) & (interval * speed < LEAST * 1e-10))
    if lost.any():
        count = max(1, int(np.argmax(lost)))
        left, right, interval, speed = (column[:count] for column in (left, right, interval, speed))
    start = initial_state(scene)
    bodies = len(start["x"])
    # Bodies that have met somebody, and the next one on each side.
    first = max(0, int(min(left.min(), right.min())) - 1)
    end = min(bodies, int(max(left.max(), right.max())) + 2)
    if start["length"]:
        first, end = 0, bodies
    part = slice(first, end)
    kind = _kinds(scene, left, right, events["time"][:count], events["time_low"][:count], speed)
    digits, keep_speed = 52, True
    if count > FULL_CONTACTS:
        keep_speed = not _speeds_follow(scene, start, left, right, speed, kind)
        digits = 24 if keep_speed else 40
    beside = np.where(left + 1 < bodies, left + 1, 0) if start["length"] else left + 1
    body_type = np.uint16 if end - first <= 1 << 16 else np.uint32
    reached = _text(file.attrs.get("outcome", "")) == "reached the end" and count == total
    collapse = file["collapse"].attrs if "collapse" in file else None
    return {
        "kind": "contacts", "start": _number(scene["run"].get("start", 0)), "first": first, "length": start["length"],
        "end": _number(scene["run"]["until"]) if reached else None, "contacts": count, "total": total,
        "digits": int(digits * 0.30103),
        "collapse": None if collapse is None else {"time": float(collapse["time"])},
        "x": pack(start["x"][part]), "v": pack(start["v"][part]), "gap": pack(start["gap"][first:end]),
        "mass": None if np.all(start["m"] == 1) else pack(start["m"][part]),
        "left": pack((left - first).astype(body_type)),
        "right": None if np.array_equal(right, beside) else pack((right - first).astype(body_type)),
        "interval": pack(interval, digits), "speed": pack(speed, digits) if keep_speed else None,
        "event": pack(kind) if kind.any() else None}


def _snapshots(file):
    """The bodies at each snapshot: gaps and closing speeds, place and velocity of the first one."""
    found = []
    for name in sorted(file["snapshots"]):
        group = file["snapshots"][name]
        if len(group["x"]) < 2:
            continue
        index, mass, gap, speed = (group[key][:] for key in ("index", "m", "gap", "closing_speed"))
        bodies = len(index)
        in_a_row = np.array_equal(index, index[0] + np.arange(bodies, dtype=index.dtype))
        found.append({
            "time": float(group.attrs["time"]), "bodies": bodies, "first": int(index[0]),
            "index": None if in_a_row else pack(index.astype(np.uint32)),
            "x": float(group["x"][0]), "v": float(group["v"][0]),
            "mass": None if np.all(mass == 1) else pack(mass),
            "gap": pack(gap[:bodies - 1], 32), "speed": pack(speed[:bodies - 1], 32)})
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
    """Of each contact 0: by the law, 1: elastic, 2: merge. Wet contacts are 0: their masses decide."""
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
    """Time since the last contact that one of the two bodies had; infinite where there was none."""
    count = len(left)
    body, contact = np.concatenate((left, right)), np.tile(np.arange(count), 2)
    order = np.lexsort((contact, body))
    body, contact = body[order], contact[order]
    since = np.full(2 * count, np.inf)
    same = body[1:] == body[:-1]
    now, before = contact[1:][same], contact[:-1][same]
    since[1:][same] = (time[now] - time[before]) + (time_low[now] - time_low[before])
    rest = np.full(count, np.inf)
    np.minimum.at(rest, contact, since)
    return rest


def _speeds_follow(scene, start, left, right, speed, kind):
    """Whether initial velocities and the law give every closing speed again; only where all masses are equal."""
    if scene["law"]["type"] != "inelastic" or np.any(start["m"] != 1) or np.any(kind == 2):
        return False
    restitution = np.where(kind == 1, 1.0, _number(scene["law"]["restitution"]))
    kick = (1 + restitution) * speed / 2
    count = len(left)
    body, contact = np.concatenate((left, right)), np.tile(np.arange(count), 2)
    side = np.concatenate((np.zeros(count, np.int8), np.ones(count, np.int8)))
    order = np.lexsort((contact, body))
    body, contact, side = body[order], contact[order], side[order]
    gained = np.where(side == 0, -kick[contact], kick[contact])
    so_far = np.cumsum(gained) - gained
    begins = np.concatenate(([0], np.flatnonzero(body[1:] != body[:-1]) + 1))
    so_far -= np.repeat(so_far[begins], np.diff(np.append(begins, len(body))))
    velocity = np.empty((2, count))
    velocity[side, contact] = start["v"][body] + so_far
    return bool(np.all(np.abs(velocity[0] - velocity[1] - speed) <= SPEED_ERROR * speed))


# The initial state, as the engine sets it up (core/rows.hpp, core/ring.hpp, core/counter_rng.hpp)


def initial_state(scene):
    """The bodies at the start: `x`, `v`, `m` and `gap` (to the next one; on a ring the last one's too, else 0 there),
    float64 of length n; `length` of a ring, else 0."""
    initial = scene["initial"]
    return {"rows": _rows, "ring": _ring, "list": _list}[initial["type"]](initial)


def _list(initial):
    x, v = (np.array([_number(value) for value in initial[key]]) for key in ("x", "v"))
    m = np.array([_number(value) for value in initial["m"]]) if "m" in initial else np.ones(len(x))
    return {"x": x, "v": v, "m": m, "gap": np.append(np.diff(x), 0.0), "length": 0}


def _rows(initial):
    rows, centre = [], initial.get("centre", {})
    for side, sign in (("left", 1), ("right", -1)):
        row = initial.get(side)
        if row is None:
            rows.append((int(initial.get("particles", 8000)) // 2, sign * _number(initial.get("speed", 0.5)),
                         _number(initial.get("spacing", 1))))
        else:
            rows.append((int(row["particles"]), _number(row["speed"]), 1 / _number(row.get("density", 1))))
    (count_left, v_left, l_left), (count_right, v_right, l_right) = rows
    middle = 1 if _number(centre.get("mass", 0)) > 0 else 0
    bodies = count_left + count_right + middle
    body = np.arange(bodies)
    from_left = body < count_left
    half_steps = np.where(from_left, 2 * (body - count_left) + 1, 2 * (body - count_left - middle) + 1)
    place = half_steps * 2 ** 27 + _displacements(initial, bodies)
    spacing = np.where(from_left, l_left, l_right)
    v, m = np.where(from_left, v_left, v_right), np.ones(bodies)
    if middle:
        place[count_left] = 0
        v[count_left], m[count_left] = _number(centre.get("speed", 0)), _number(centre["mass"])
    gap = np.diff(place) * spacing[:-1] * UNIT
    across = slice(count_left - 1, count_left + middle)  # where the two spacings meet
    x = place * spacing * UNIT
    if l_left != l_right or middle:
        gap[across] = np.diff(x)[across]
    return {"x": x, "v": v, "m": m, "gap": np.append(gap, 0.0), "length": 0}


def _ring(initial):
    bodies = int(initial.get("particles", 8000))
    length = _number(initial.get("length", bodies))
    body, shift = np.arange(bodies), _displacements(initial, bodies)
    unit = length / bodies * UNIT
    seed, replica = int(initial.get("seed", 1)), int(initial.get("replica", 0))
    pace = np.zeros(bodies, np.int64)
    if initial.get("velocities", "gaussian") == "uniform":
        pace = _uniform(_random_bits(seed, replica, _attempt(body, 0)), 464943848)
    else:  # Marsaglia's polar method: who falls outside the unit circle tries again
        missing, attempt = body, 0
        while len(missing):
            bits = _random_bits(seed, replica, _attempt(missing, attempt))
            u, v = (((half.astype(np.float64) + 0.5) * 2.0 ** -31 - 1) for half in (bits >> 32, bits & 0xFFFFFFFF))
            square = u * u + v * v
            good = square < 1
            normal = u[good] * np.sqrt(-2 * np.log(square[good]) / square[good])
            pace[missing[good]] = np.floor(normal / UNIT + 0.5).astype(np.int64)
            missing, attempt = missing[~good], attempt + 1
    # The mean is subtracted; what is left of the division, less than a unit per body, from the first ones.
    total = int(pace.sum())
    mean = total // bodies
    pace = pace - mean - (body < total - mean * bodies)
    v = pace * (np.sqrt(_number(initial.get("variance", 1))) * UNIT)
    return {"x": ((2 * body + 1) * 2 ** 27 + shift) * unit, "v": v, "m": np.ones(bodies),
            "gap": (2 ** 28 + np.roll(shift, -1) - shift) * unit, "length": length}


def _displacements(initial, bodies):
    bound = int(np.floor(_number(initial.get("perturbation", 0)) / UNIT))
    bits = _random_bits(int(initial.get("seed", 1)), int(initial.get("replica", 0)), np.arange(bodies, dtype=np.uint64))
    return _uniform(bits, bound)


def _attempt(body, attempt):
    return body.astype(np.uint64) | np.uint64((attempt + 1) << 56)


def _uniform(bits, bound):
    wide, low = np.uint64(2 * bound + 1), np.uint64(0xFFFFFFFF)
    half = np.uint64(32)
    return (((bits >> half) * wide + (((bits & low) * wide) >> half)) >> half).astype(np.int64) - bound


def _random_bits(seed, replica, index):
    """Philox4x32-10 of (seed, replica, index), 64 bits each; index: an array of uint64."""
    low, half = np.uint64(0xFFFFFFFF), np.uint64(32)
    key = [seed & 0xFFFFFFFF, seed >> 32]
    words = [index & low, index >> half, np.full_like(index, replica & 0xFFFFFFFF), np.full_like(index, replica >> 32)]
    for _ in range(10):
        a, b = np.uint64(0xD2511F53) * words[0], np.uint64(0xCD9E8D57) * words[2]
        words = [(b >> half) ^ words[1] ^ np.uint64(key[0]), b & low,
                 (a >> half) ^ words[3] ^ np.uint64(key[1]), a & low]
        key = [(key[0] + 0x9E3779B9) & 0xFFFFFFFF, (key[1] + 0xBB67AE85) & 0xFFFFFFFF]
    return words[0] | words[1] << half


def _number(value):
    return float(value)


def _text(value):
    return value.decode() if isinstance(value, bytes) else str(value)


# What a page needs beside the data, in this order.
SCRIPTS = ("microscope_world.js", "microscope_gaps.js", "microscope_chart.js", "microscope_camera.js",
           "microscope_view.js", "microscope_overview.js", "microscope_hands.js", "microscope.js")
STYLES = ("microscope.css",)
