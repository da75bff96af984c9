import numpy as np
import pytest

from murkscan.errors import InputError
from murkscan.geometry.grid import NONE, ScanGrid, reverse_links

from ..scans import holed, plane, scan_cloud


def neighbours_in_rows(cloud, profiles, lines):
    """The same by a table: the slow and plain way."""
    cells = {(f, s): i for i, (f, s) in enumerate(zip(cloud.frame, cloud.scan_line, strict=True))}
    return [
        cells.get((f + profiles, s + lines), NONE)
        for f, s in zip(cloud.frame, cloud.scan_line, strict=True)
    ]


@pytest.mark.parametrize("offset", [(0, 1), (0, -2), (1, 0), (-1, 1), (3, -3)])
def test_the_nearest_is_the_point_in_that_cell(offset):
    cloud = scan_cloud(holed, spacing=5e-3)
    grid = ScanGrid.from_cloud(cloud)
    np.testing.assert_array_equal(grid.nearest(*offset), neighbours_in_rows(cloud, *offset))


def test_the_order_of_the_points_does_not_matter():
    cloud = scan_cloud(holed, spacing=5e-3)
    order = np.random.default_rng(0).permutation(len(cloud))
    mixed = type(cloud)(*(getattr(cloud, name)[order] for name in cloud.__dataclass_fields__))
    links, mixed_links = (ScanGrid.from_cloud(c).linked(1, 0) for c in (cloud, mixed))
    there = np.where(mixed_links == NONE, NONE, order[mixed_links])
    np.testing.assert_array_equal(there, links[order])


def test_a_link_goes_both_ways():
    links = ScanGrid.from_cloud(scan_cloud(holed, spacing=5e-3)).linked(0, 1)
    here = np.flatnonzero(links != NONE)
    np.testing.assert_array_equal(reverse_links(links)[links[here]], here)


def test_fields_link_to_the_field_before_and_after():
    cloud = scan_cloud(plane, interlaced=True)
    links = ScanGrid.from_cloud(cloud).linked(1, 0)
    here = np.flatnonzero(links != NONE)
    assert len(here) == len(cloud) - 100  # all but the last field's
    np.testing.assert_array_equal(cloud.frame[links[here]], cloud.frame[here] + 1)
    assert np.abs(cloud.scan_line[links[here]] - cloud.scan_line[here]).max() == 1


def test_every_third_frame_is_a_whole_scan_and_a_missing_one_a_gap():
    cloud = scan_cloud(plane)
    thirds = cloud[(cloud.frame % 3 == 0) & (cloud.frame != 60)]
    links = ScanGrid.from_cloud(thirds).linked(1, 0)
    lonely = np.unique(thirds.frame[links == NONE])
    np.testing.assert_array_equal(lonely, [57, 117])


@pytest.mark.parametrize("jump", [0.0, -1.0, np.nan])
def test_a_jump_of_nothing_is_refused(jump):
    with pytest.raises(InputError, match="max_jump"):
        ScanGrid.from_cloud(scan_cloud(plane, spacing=0.02), max_jump=jump)
