"""murkscan simulate: make a recording whose truth is known."""

from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from ..errors import InputError
from .progress import progress_bars
from .typed import WORDS
from .words import say, tell

if TYPE_CHECKING:
    from ..simulate import Scene


def simulate(
    scene: str | None = None,
    out: Path | None = None,
    *,
    show_list: Annotated[bool, Parameter(name="--list", negative=())] = False,
) -> None:
    """Make a recording whose truth is known: light through water and glass, as a camera keeps it.

    Parameters
    ----------
    scene
        A scene file, or the name of a scene that ships with murkscan, such as hull-c3.
    out
        Folder for frames/ or recording.mkv, rig.toml, poses.csv and truth/; of an artefact's scene
        acceptance.toml, too.
    show_list
        Show the scenes that ship with murkscan.
    """
    if show_list:
        _print_scenes()
        return
    if scene is None or out is None:
        raise InputError(
            "Give a scene and a folder: murkscan simulate SCENE OUT; --list shows what is there."
        )
    from ..simulate import as_standalone, parse_scene, read_scene
    from ..survey.simulate import simulate_recording

    text, name, folder = read_scene(scene)
    made_of = parse_scene(text, name, folder)
    text = as_standalone(text, made_of.rig, folder)
    with progress_bars() as progress:
        made = simulate_recording(made_of, out, text=text, command=WORDS.get(), progress=progress)
    fields = f", {made.num_frames} fields" if made.num_pictures < made.num_frames else ""
    tell("recording", f"{made.num_pictures} pictures{fields}: {made.recording}")
    tell("rig", str(out / "rig.toml"))
    tell("poses", str(out / "poses.csv"))
    if made.num_centres:
        tell("truth", f"{made.num_centres:,} true centres of the stripe: {out / 'truth'}")
    tell("next", *_next_steps(made_of, made.recording, out))


def _next_steps(scene: "Scene", recording: Path, out: Path) -> list[str]:
    """Say what the recording can be used for."""
    from ..simulate.instruments import Instruments
    from ..simulate.textures.checkered import Checkered

    if boards := [b.texture for b in scene.bodies if isinstance(b.texture, Checkered)]:
        board = boards[0]
        step = "laser" if scene.rig.lasers else "port" if scene.rig.camera.port else "camera"
        return [
            f"murkscan calibrate {step} {quote(str(recording))} --board "
            f"{board.columns}x{board.rows} --square-mm {1e3 * board.square:g} --rig RIG"
        ]
    steps = [
        f"murkscan scan {quote(str(recording))} --rig {quote(str(out / 'rig.toml'))} --poses "
        f"{quote(str(out / 'poses.csv'))} --out SCAN"
    ]
    if isinstance(scene.navigation, Instruments):
        speed = "" if scene.navigation.kind == "dvl" else " --speed-mm-s V"
        steps.append(
            f"murkscan scan {quote(str(recording))} --rig {quote(str(out / 'rig.toml'))} "
            f"--navigation {quote(str(out / 'navigation.csv'))}{speed} --out SCAN"
        )
    if scene.acceptance:
        steps.append(f"murkscan accept SCAN --test {quote(str(out / 'acceptance.toml'))}")
    return steps


def _print_scenes() -> None:
    from ..simulate import list_scenes

    scenes = list_scenes()
    width = max(map(len, scenes)) + 2
    for name, line in scenes.items():
        tell(name, line, indent=width)
    say(
        "Add -c0.3, -c0.5, -c1.5, -c3, -c4, -c5 or -c6 for water of that beam attenuation per "
        "metre, and (but for chessboards) -hd for a machine-vision rig: hull-c3-hd."
    )
