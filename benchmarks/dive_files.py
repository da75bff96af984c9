"""Files as vehicles write them, made by the formats' own libraries: MCAP, bags, a .tlog, CSV."""

import base64
import json
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from pathlib import Path

import av
import numpy as np
from scipy.spatial.transform import Rotation

from murkscan.types.trajectory import Trajectory

BEGIN = 1_777_627_800.0
"""When recordings begin [s since 1970]: 2026-05-01T09:30:00Z."""
BOOT = 100.0
"""How long the autopilot has been on by then [s]."""
VIDEO = "video/UDP Stream/stream"
COMPRESSED_VIDEO = """builtin_interfaces/Time timestamp
string frame_id
uint8[] data
string format
"""


@dataclass(frozen=True, eq=False)
class Dive:
    """What happened, by the true clock."""

    packets: list[bytes]
    """One H.264 access unit a picture, keyframes among them."""
    times: np.ndarray
    """When each picture was taken [s from the beginning]."""
    way: Trajectory
    """world_from_vehicle, 10 Hz, of the same clock."""

    @cached_property
    def angles(self) -> np.ndarray:
        """Roll, pitch, heading [rad]."""
        turns = Rotation.from_quat(self.way.quaternions, scalar_first=True)
        return turns.as_euler("ZYX")[:, ::-1]

    @cached_property
    def rates(self) -> np.ndarray:
        """Turn rates about the vehicle's axes [rad/s]."""
        turns = Rotation.from_quat(self.way.quaternions, scalar_first=True)
        steps = (turns[:-1].inv() * turns[1:]).as_rotvec() / np.diff(self.way.times)[:, None]
        return np.vstack([steps, steps[-1:]])


@dataclass(frozen=True)
class Flaws:
    """What recorders do to times."""

    jitter: float = 0.0
    """Of stamps of arrival, 1σ [s]."""
    delay: float = 0.0
    """Of pictures [s]."""
    step_at: float = np.inf
    """When the clock steps [s from the beginning]."""
    step: float = 0.0
    """By how much [s]; negative: back."""
    cut: float = 1.0
    """Share of the file that is left."""


def encode_h264(pictures, rate: float, *, gop: int = 25, crf: int = 18, codec: str = "libx264"):
    """Encode grey pictures as access units with start codes, one a picture, without B-frames."""
    height, width = pictures[0].shape
    context = av.CodecContext.create(codec, "w")
    context.width, context.height, context.pix_fmt = width, height, "yuv420p"
    context.time_base, context.framerate = Fraction(1, round(rate)), Fraction(round(rate))
    every = f"keyint={gop}:repeat-headers=1:bframes=0:scenecut=0:annexb=1"
    context.options = {
        "crf": str(crf), "preset": "fast", "tune": "zerolatency", "g": str(gop), "bf": "0",
        "threads": "1", "x264-params": every,
        "x265-params": f"{every}:log-level=none",
    }  # fmt: skip
    packets = []
    for number, picture in enumerate(pictures):
        flat = np.full((height // 2, width), 128, np.uint8)
        frame = av.VideoFrame.from_ndarray(np.concatenate([picture, flat]), "yuv420p")
        frame.pts = number
        packets += [bytes(packet) for packet in context.encode(frame)]
    return packets + [bytes(packet) for packet in context.encode(None)]


def write_mp4(path: Path, dive: Dive, rate: float, codec: str = "h264") -> None:
    """Write the packets as they are into MP4, each picture at its own time."""
    with av.open(str(path), "w") as container:
        template = av.CodecContext.create(codec, "r")
        decoded = [f for p in dive.packets[:3] for f in template.decode(av.Packet(p))]
        decoded = decoded or template.decode(None)
        stream = container.add_stream(codec, rate=Fraction(round(rate)))
        stream.width, stream.height = decoded[0].width, decoded[0].height
        stream.pix_fmt, stream.time_base = "yuv420p", Fraction(1, 90_000)
        for packet, time in zip(dive.packets, dive.times, strict=True):
            one = av.Packet(packet)
            one.stream, one.time_base = stream, Fraction(1, 90_000)
            one.pts = one.dts = round(time * 90_000)
            one.is_keyframe = _is_key(packet)
            container.mux(one)


def _is_key(packet: bytes) -> bool:
    return any(packet[k + 3] & 0x1F == 5 for k in range(len(packet) - 4)
               if packet[k : k + 3] == b"\0\0\1")  # fmt: skip


def _events(dive: Dive, flaws: Flaws, seed: int = 0):
    """Give pictures and navigation in the order of arrival: stamp [ns], kind, number."""
    random = np.random.default_rng(seed)
    late = flaws.delay + np.abs(random.normal(0, flaws.jitter, len(dive.times)))
    events = [(t + d, "picture", k) for k, (t, d) in enumerate(zip(dive.times, late, strict=True))]
    late = np.abs(random.normal(0, flaws.jitter, len(dive.way.times)))
    events += [(t + d, "way", k) for k, (t, d) in enumerate(zip(dive.way.times, late, strict=True))]
    # Pictures and messages come over one wire each, so that neither overtakes its own kind.
    latest = {"picture": -np.inf, "way": -np.inf}
    ordered = []
    for kind in latest:
        for time, which, number in sorted(e for e in events if e[1] == kind):
            latest[kind] = max(latest[kind] + 1e-6, time)
            ordered.append((latest[kind], which, number))
    ordered = sorted((t, which, number) for t, which, number in ordered)
    numbers = {"picture": 0, "way": 0}
    for time, kind, _ in ordered:
        clock = BEGIN + time + (flaws.step if time >= flaws.step_at else 0.0)
        yield round(clock * 1e9), kind, numbers[kind]
        numbers[kind] += 1


def mavlink_messages(dive: Dive, k: int, *, position: bool) -> dict[str, dict]:
    """Give what the autopilot sends at one time."""
    boot = round((BOOT + dive.way.times[k]) * 1e3)
    roll, pitch, yaw = dive.angles[k].tolist()
    rates = dict(zip(("rollspeed", "pitchspeed", "yawspeed"), dive.rates[k].tolist(), strict=True))
    north, east, down = dive.way.positions[k].tolist()
    sent = {
        "ATTITUDE": {"time_boot_ms": boot, "roll": roll, "pitch": pitch, "yaw": yaw, **rates},
        "SCALED_PRESSURE2": {
            "time_boot_ms": boot, "press_abs": (101_325 + (5 + down) * 1025 * 9.81) / 100,
            "press_diff": 0.0, "temperature": 2000,
        },
    }  # fmt: skip
    if position:
        sent["LOCAL_POSITION_NED"] = {
            "time_boot_ms": boot, "x": north, "y": east, "z": down, "vx": 0.0, "vy": 0.0, "vz": 0.0,
        }  # fmt: skip
    return sent


def write_blueos(
    path: Path,
    dive: Dive,
    *,
    flaws: Flaws | None = None,
    position: bool = True,
    json_video: bool = False,
    cameras: tuple[str, ...] = (VIDEO,),
    form: str = "h264",
    repeats: int = 1,
    seed: int = 0,
    chunk_size: int = 1 << 20,
) -> None:
    """Write an MCAP as BlueOS does: MAVLink as JSON, video as CDR or JSON.

    `position` is whether the vehicle knows where it is; `form` what the recorder calls the codec;
    with `repeats` the dive is written several times, one after another.
    """
    from mcap.writer import CompressionType, Writer

    flaws = flaws or Flaws()
    with path.open("wb") as file:
        writer = Writer(file, chunk_size=chunk_size, compression=CompressionType.ZSTD)
        writer.start(profile="", library="blueos-recorder")
        channels: dict[str, int] = {}
        length = float(dive.times[-1] + 1 / 25)
        for turn in range(repeats):
            later = replace(
                dive, times=dive.times + turn * length,
                way=replace(dive.way, times=dive.way.times + turn * length),
            )  # fmt: skip
            for stamp, kind, k in _events(later, flaws, seed + turn):
                if kind == "picture":
                    for camera in cameras:
                        _add_video(
                            writer, channels, camera, stamp, dive.packets[k], json_video, form
                        )
                    continue
                for name, message in mavlink_messages(later, k, position=position).items():
                    topic = f"mavlink/1/1/{name}"
                    if topic not in channels:
                        schema = writer.register_schema(
                            topic.replace("/", "."), "jsonschema", b'{"type":"object"}'
                        )
                        channels[topic] = writer.register_channel(topic, "json", schema)
                    data = {"header": {"system_id": 1, "component_id": 1},
                            "message": {"type": name, **message}}  # fmt: skip
                    writer.add_message(channels[topic], stamp, json.dumps(data).encode(), stamp)
        writer.finish()
    if flaws.cut < 1:
        with path.open("r+b") as file:
            file.truncate(int(path.stat().st_size * flaws.cut))


def _add_video(writer, channels, topic, stamp, packet, as_json, form) -> None:
    if topic not in channels:
        schema = writer.register_schema(
            "foxglove.CompressedVideo",
            "jsonschema" if as_json else "ros2msg",
            b'{"type":"object"}' if as_json else COMPRESSED_VIDEO.encode(),
        )
        channels[topic] = writer.register_channel(topic, "json" if as_json else "cdr", schema)
    seconds, nanoseconds = divmod(stamp, 1_000_000_000)
    if as_json:
        value = {
            "timestamp": {"sec": seconds, "nsec": nanoseconds}, "frame_id": "vehicle",
            "data": base64.b64encode(packet).decode(), "format": form,
        }  # fmt: skip
        data = json.dumps(value).encode()
    else:
        data = _serialize_video(seconds, nanoseconds, packet, form)
    writer.add_message(channels[topic], stamp, data, stamp)


def _video_store():
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    store.register(get_types_from_msg(COMPRESSED_VIDEO, "foxglove/msg/CompressedVideo"))
    return store


_STORES: dict[str, object] = {}


def _serialize_video(seconds: int, nanoseconds: int, packet: bytes, form: str) -> bytes:
    store = _STORES.setdefault("video", _video_store())
    types = store.types
    value = types["foxglove/msg/CompressedVideo"](
        timestamp=types["builtin_interfaces/msg/Time"](sec=seconds, nanosec=nanoseconds),
        frame_id="vehicle",
        data=np.frombuffer(packet, np.uint8),
        format=form,
    )
    return bytes(store.serialize_cdr(value, "foxglove/msg/CompressedVideo"))


def write_ros2(path: Path, dive: Dive, storage: str) -> None:
    """Write a bag of ROS 2: `sqlite3` or `mcap`; video and nav_msgs/Odometry."""
    from rosbags.rosbag2 import StoragePlugin, Writer

    store = _STORES.setdefault("video", _video_store())
    plugin = StoragePlugin.MCAP if storage == "mcap" else StoragePlugin.SQLITE3
    with Writer(path, version=9, storage_plugin=plugin) as writer:
        video = writer.add_connection(
            "/camera/video", "foxglove/msg/CompressedVideo", typestore=store
        )
        odometry = writer.add_connection("/odom", "nav_msgs/msg/Odometry", typestore=store)
        for stamp, kind, k in _events(dive, Flaws()):
            if kind == "picture":
                data = _serialize_video(*divmod(stamp, 1_000_000_000), dive.packets[k], "h264")
                writer.write(video, stamp, data)
            else:
                value = _odometry(store, dive, k, stamp)
                writer.write(odometry, stamp, store.serialize_cdr(value, "nav_msgs/msg/Odometry"))


def write_ros1(path: Path, dive: Dive, pictures) -> None:
    """Write a bag of ROS 1 with raw pictures and nav_msgs/Odometry."""
    from rosbags.rosbag1 import Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS1_NOETIC)
    writer = Writer(path)
    writer.set_compression(Writer.CompressionFormat.LZ4)
    with writer:
        image = writer.add_connection("/camera/image_raw", "sensor_msgs/msg/Image", typestore=store)
        odometry = writer.add_connection("/odom", "nav_msgs/msg/Odometry", typestore=store)
        for stamp, kind, k in _events(dive, Flaws()):
            if kind == "way":
                value = _odometry(store, dive, k, stamp)
                data = store.serialize_ros1(value, "nav_msgs/msg/Odometry")
                writer.write(odometry, stamp, data)
                continue
            picture = pictures[k]
            value = store.types["sensor_msgs/msg/Image"](
                header=_header(store, stamp, "camera"), height=picture.shape[0],
                width=picture.shape[1], encoding="mono8", is_bigendian=0, step=picture.shape[1],
                data=picture.reshape(-1),
            )  # fmt: skip
            writer.write(image, stamp, store.serialize_ros1(value, "sensor_msgs/msg/Image"))


def _header(store, stamp, frame):
    types, (seconds, nanoseconds) = store.types, divmod(stamp, 1_000_000_000)
    time = types["builtin_interfaces/msg/Time"](sec=seconds, nanosec=nanoseconds)
    kind = types["std_msgs/msg/Header"]
    with_seq = "seq" in kind.__dataclass_fields__
    return kind(seq=0, stamp=time, frame_id=frame) if with_seq else kind(time, frame)


def _odometry(store, dive, k, stamp):
    types, place = store.types, dive.way.positions[k]
    w, x, y, z = dive.way.quaternions[k]
    vector = types["geometry_msgs/msg/Vector3"]
    zero = vector(x=0.0, y=0.0, z=0.0)
    pose = types["geometry_msgs/msg/Pose"](
        position=types["geometry_msgs/msg/Point"](x=place[0], y=place[1], z=place[2]),
        orientation=types["geometry_msgs/msg/Quaternion"](x=x, y=y, z=z, w=w),
    )
    return types["nav_msgs/msg/Odometry"](
        header=_header(store, stamp, "odom"),
        child_frame_id="base_link",
        pose=types["geometry_msgs/msg/PoseWithCovariance"](pose=pose, covariance=np.zeros(36)),
        twist=types["geometry_msgs/msg/TwistWithCovariance"](
            twist=types["geometry_msgs/msg/Twist"](linear=zero, angular=zero),
            covariance=np.zeros(36),
        ),
    )


def write_tlog(path: Path, dive: Dive, *, position: bool = True) -> None:
    """Write a .tlog: each packet behind its time of arrival."""
    from pymavlink.dialects.v20 import ardupilotmega as mavlink

    link = mavlink.MAVLink(None, srcSystem=1, srcComponent=1)
    with path.open("wb") as file:
        for k, time in enumerate(dive.way.times):
            for name, message in mavlink_messages(dive, k, position=position).items():
                if name == "SCALED_PRESSURE2":
                    message = {**message, "press_diff": 0.0}
                made = getattr(mavlink, f"MAVLink_{name.lower()}_message")(**message)
                stamp = round((BEGIN + time) * 1e6)
                file.write(stamp.to_bytes(8, "big") + made.pack(link))


def write_csv(path: Path, dive: Dive) -> None:
    """Write the columns of a log of measurements."""
    head = "time_s,roll_deg,pitch_deg,heading_deg,north_m,east_m,depth_m"
    rows = np.column_stack(
        [BEGIN + dive.way.times, np.degrees(dive.angles), dive.way.positions]
    ).tolist()
    path.write_text("\n".join([head, *(",".join(map(repr, row)) for row in rows)]) + "\n")
