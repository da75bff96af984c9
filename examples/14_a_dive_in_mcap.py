"""A dive in MCAP
==============

Pictures and the vehicle's own log out of one file, as BlueOS and ROS 2 record them.

The file is made here, by the format's own library: pictures of a simulated dive, and what the
autopilot says of place and attitude. It needs the extra `dive`: ``pip install ".[dive]"``.
"""

import base64
import json
import tempfile
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
from mcap.writer import Writer
from scipy.spatial.transform import Rotation

import murkscan as ms
from murkscan.cli.main import run
from murkscan.io.rig_toml import save_rig
from murkscan.simulate import load_scene
from murkscan.simulate.frames import Simulator

BEGIN = 1_777_627_800.0  # 2026-05-01T09:30:00Z, in seconds since 1970

folder = Path(tempfile.mkdtemp())
scene = load_scene("two-lasers")
scene = replace(scene, times=scene.times[:12])
simulator, way = Simulator.of(scene), scene.trajectory.at(scene.times)
angles = Rotation.from_quat(way.quaternions, scalar_first=True).as_euler("ZYX")[:, ::-1]


def write(writer, channels, topic, time, message):
    """Add a message as JSON."""
    if topic not in channels:
        schema = writer.register_schema(topic.split("/")[-1], "jsonschema", b"{}")
        channels[topic] = writer.register_channel(topic, "json", schema)
    stamp = round(1e9 * (BEGIN + time))
    writer.add_message(channels[topic], stamp, json.dumps(message).encode(), stamp)


with (folder / "dive.mcap").open("wb") as file:
    writer, channels = Writer(file), {}
    writer.start(library="an example")
    for number, time in enumerate(scene.times.tolist()):
        picture = cv2.imencode(".png", simulator.draw_frame(number).frame.image)[1]
        image = {
            "timestamp": {"sec": int(BEGIN + time), "nsec": round(1e9 * (time % 1))},
            "data": base64.b64encode(picture.tobytes()).decode(), "format": "png",
        }  # fmt: skip
        write(writer, channels, "camera/foxglove.CompressedImage", time, image)
        boot = {"time_boot_ms": round(1e3 * time)}
        attitude = dict(zip(("roll", "pitch", "yaw"), angles[number].tolist(), strict=True))
        place = dict(zip("xyz", way.positions[number].tolist(), strict=True))
        for name, said in (("ATTITUDE", attitude), ("LOCAL_POSITION_NED", place)):
            message = {"message": {"type": name, **boot, **said}}
            write(writer, channels, f"mavlink/1/1/{name}", time, message)
    writer.finish()
save_rig(folder / "rig.toml", scene.rig)

# What is in it, and then all of it: murkscan scan dive.mcap --rig rig.toml --out scan
run(["dive", str(folder / "dive.mcap")])
rig, out = ("--rig", str(folder / "rig.toml")), ("--out", str(folder / "scan"))
run(["scan", str(folder / "dive.mcap"), *rig, *out])

cloud = ms.Project(folder / "scan").load_cloud()
width, length, _ = 1e3 * np.ptp(cloud.points, axis=0)
print(f"{len(cloud):,} points of a strip of {width:.0f} × {length:.0f} mm")
