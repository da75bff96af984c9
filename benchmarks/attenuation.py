"""How murky was the water? The attenuation that a recording's glow tells, beside the true one."""

from dataclasses import replace

from harness import Figure, tell

from murkscan.extract import Murk
from murkscan.simulate import Scene, Simulator, load_scene
from murkscan.types.background import Attenuation

RUNGS = (1.5, 3.0, 4.0, 5.0, 6.0)
FRAMES = 24
"""Fields that are looked at, spread over the recording as `scan` does."""


def main() -> None:
    figures: list[Figure] = []
    for attenuation in RUNGS:
        scene = load_scene(f"hull-c{attenuation:g}")
        once = estimate(replace(scene, forward_scattering=False))
        often = estimate(scene)
        name = f"c = {attenuation:g} /m"
        off = 100 * abs(once.effective / attenuation - 1)
        figures += [
            Figure(f"{name}, scattered once: effective attenuation", once.effective, "/m"),
            Figure(f"{name}, scattered once: off", off, "%", at_most=10),
            Figure(f"{name}, all scattering: effective attenuation", often.effective, "/m"),
            Figure(f"{name}, all scattering: interval from", often.low, "/m"),
            Figure(f"{name}, all scattering: interval to", often.high, "/m"),
        ]
    tell(
        "attenuation",
        "The water's attenuation, told from the sheet's glow",
        figures,
        note=f"The ladder's hull, {FRAMES} fields of each recording, with particles and noise; "
        "scattered once: the simulator's forward scattering is left out. At 1.5 /m the glow is "
        "less than one grey level then. With all scattering the glow is several times brighter and "
        "broad, and fades little by little: the value means little, and the interval spans nearly "
        "all that water can be, which holds c but tells nothing.",
    )


def estimate(scene: Scene) -> Attenuation:
    simulator = Simulator.of(scene)
    numbers = [round(i * (len(scene) - 2) / (FRAMES - 1)) // 2 * 2 + i % 2 for i in range(FRAMES)]
    frames = [simulator.draw_frame(number).frame for number in numbers]
    found = Murk().learn(frames, scene.rig).attenuation
    assert found is not None
    return found


if __name__ == "__main__":
    main()
