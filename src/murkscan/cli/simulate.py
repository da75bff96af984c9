"""murkscan simulate: make a recording whose truth is known."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from ..errors import InputError
from .progress import progress_bars


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
        Folder for frames/ or recording.mkv, rig.toml, poses.csv and truth/.
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
        made = simulate_recording(made_of, out, text=text, progress=progress)
    fields = f", {made.num_frames} fields" if made.num_pictures < made.num_frames else ""
    print(f"recording  {made.recording}: {made.num_pictures} pictures{fields}")
    print(f"rig        {out / 'rig.toml'}")
    print(f"poses      {out / 'poses.csv'}")
    print(f"truth      {out / 'truth'}: {made.num_centres:,} true centres of the stripe")


def _print_scenes() -> None:
    from ..simulate import list_scenes

    scenes = list_scenes()
    width = max(map(len, scenes)) + 2
    for name, line in scenes.items():
        print(f"{name:{width}}{line}")
    print(
        "\nAdd -c0.3, -c0.5, -c1.5, -c3, -c4, -c5 or -c6 for water of that beam attenuation per "
        "metre,\nand (but for chessboards) -hd for a machine-vision rig: hull-c3-hd."
    )
