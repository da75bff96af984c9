"""Pictures of what a finder found, missed and made up in real photographs, to be looked at."""

from pathlib import Path

import cv2
import numpy as np
from real_judge import Judged
from real_sets import Shot

from murkscan.types.frame import Frame

_ZOOM = 2
_RIGHT, _FALSE, _MISSED = (60, 220, 60), (40, 60, 255), (255, 200, 40)
"""Blue, green, red of a right, a false and a missed centre."""
_BRIGHT = 200.0
"""Grey level to which a dim picture is brightened."""


def draw_overlays(
    folder: Path, shot: Shot, frames: list[Frame], verdict: dict[str, Judged]
) -> None:
    """Draw every frame for every finder: green is right, red false, blue missed."""
    is_down = shot.rig.laser(0).axis == "y"
    for name, judged in verdict.items():
        place = folder / shot.name / name
        place.mkdir(parents=True, exist_ok=True)
        for number, (frame, picture) in enumerate(zip(frames, shot.pictures(), strict=True)):
            marks = (
                (judged.true[~judged.is_hit], _MISSED),
                (judged.found[judged.is_right], _RIGHT),
                (judged.found[~judged.is_right], _FALSE),
            )
            drawn = _enlarged(frame.image)
            for rows, colour in marks:
                for _, line, position in rows[rows[:, 0] == number, :3]:
                    u, v = (line, position) if is_down else (position, line)
                    at = (round((u + 0.5) * _ZOOM - 0.5), round((v + 0.5) * _ZOOM - 0.5))
                    cv2.circle(drawn, at, 1, colour, -1)
            cv2.imwrite(str(place / f"{number:03d}_{Path(picture).stem}.png"), drawn)


def _enlarged(image: np.ndarray) -> np.ndarray:
    gain = min(_BRIGHT / max(float(np.quantile(image, 0.999)), 1.0), 4.0)
    grey = np.clip(image * gain, 0, 255).astype(np.uint8)
    size = (image.shape[1] * _ZOOM, image.shape[0] * _ZOOM)
    return cv2.cvtColor(cv2.resize(grey, size, interpolation=cv2.INTER_NEAREST), cv2.COLOR_GRAY2BGR)
