"""Run a finder of another package on pictures; it lives in an environment without murkscan.

Usage: python murk_foreign_worker.py oplab|ridge FRAMES.npy FOUND.npy
"""

import sys
import warnings

import numpy as np

MARGIN = 80


def find_by_oplab(image):
    """Find by oplab-pipeline, with the settings of its own default_calibration.yaml."""
    from auv_cal.laser_calibrator import findLaserInImage

    # It leaves out the outer 80 columns on either side, so it is given more.
    wide = np.pad(image, ((0, 0), (MARGIN, MARGIN)), mode="edge")
    found = findLaserInImage(wide, min_green_ratio=0.01, k=5, num_columns=1024)
    found = np.asarray(found, float).reshape(-1, 2)
    return found[:, 1] - MARGIN, found[:, 0]


def find_by_ridge_detector(image):
    """Find by ridge-detector, which is Steger's method, where its contours cross the columns."""
    from ridge_detector import RidgeDetector

    detector = RidgeDetector(
        line_widths=[3], low_contrast=5, high_contrast=15, min_len=5, max_len=0, dark_line=False,
        estimate_width=False, extend_line=False, correct_pos=False,
    )  # fmt: skip
    detector.detect_lines(image)
    columns, rows = [np.zeros(0)], [np.zeros(0)]
    for contour in detector.contours:
        u, v = np.asarray(contour.col, float), np.asarray(contour.row, float)
        for first, last in zip(range(len(u) - 1), range(1, len(u))):  # noqa: B905
            low, high = sorted((u[first], u[last]))
            crossed = np.arange(np.ceil(low), np.ceil(high))
            share = (crossed - u[first]) / (u[last] - u[first]) if len(crossed) else crossed
            columns.append(crossed)
            rows.append(v[first] + share * (v[last] - v[first]))
    return np.concatenate(columns), np.concatenate(rows)


def main():
    name, asked, told = sys.argv[1:]
    warnings.simplefilter("ignore")
    find = {"oplab": find_by_oplab, "ridge": find_by_ridge_detector}[name]
    parts = [np.zeros((0, 4))]
    for number, image in enumerate(np.load(asked)):
        columns, rows = find(image)
        at = np.clip(np.rint(rows).astype(int), 0, len(image) - 1)
        light = image[at, columns.astype(int)].astype(float)
        parts.append(np.stack([np.full(len(rows), float(number)), columns, rows, light], axis=1))
    np.save(told, np.concatenate(parts))


if __name__ == "__main__" and len(sys.argv) > 1:  # `make bench` runs every file of this folder
    main()
